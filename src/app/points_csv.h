// The point lists of `troffer measure`.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

struct PointList {
  std::vector<MeasuringPoint> points;
  std::string note;  // names columns that are not used; empty: none
  // A column of results for what each point lies on; empty where there is none.
  std::vector<std::string> surfaces;
};

// The columns x,y,z,nx,ny,nz in any order (lighting/csv_table.h). InputError names line and column
// of what cannot be read (a zero normal, say), and a list without points.
PointList read_points(const std::string& path);

// Returns the text as a field of a table: in quotes where it holds commas, quotes or line breaks.
std::string csv_field(const std::string& text);

// measurements_csv(), with the column "surface" at the end where the list has one.
std::string measurements_csv(const PointList& list, const MeasureResult& result);

}  // namespace troffer
