// The point lists of `troffer measure`.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

struct PointList {
  std::vector<MeasuringPoint> points;
  // Further columns, which results keep: "" or ",NAME,NAME", and the same of each point's fields.
  size_t other_count = 0;
  std::string other_names;
  std::vector<std::string> other_fields;  // empty where there are none
};

// The columns x,y,z,nx,ny,nz in any order, beside others (lighting/csv_table.h). InputError names
// line and column of what cannot be read (a zero normal, say), and a list without points.
PointList read_points(const std::string& path);

// As a field of a table: in quotes where it holds commas, quotes or line breaks.
std::string csv_field(const std::string& text);

// measurements_csv() with the list's further columns at the end of each row.
std::string measurements_csv(const PointList& list, const MeasureResult& result);

}  // namespace troffer
