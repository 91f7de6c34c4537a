// Reads the point lists of `troffer measure` and writes its results.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// Points, and remarks on the file.
struct PointList {
  std::vector<MeasuringPoint> points;
  std::string note;  // names unused columns; empty: none
  // Name of the surface of each point, for a column of the results; empty: no such column.
  std::vector<std::string> surfaces;
};

// Reads the columns x,y,z,nx,ny,nz in any order (lighting/csv_table.h). Throws InputError with line
// and column for invalid values, such as a zero normal, and for a list without points.
PointList read_points(const std::string& path);

// Returns the text as a CSV field: in quotes if it contains commas, quotes or line breaks.
std::string csv_field(const std::string& text);

// Returns measurements_csv(), with "surface" as the last column if the list has surfaces.
std::string measurements_csv(const PointList& list, const MeasureResult& result);

}  // namespace troffer
