// Writes hourly illuminance in the layout of Honeybee's annual daylight results, which Ladybug
// Tools post-process: grids_info.json, sun-up-hours.txt, and one array per grid.
//
// References: [1] Ladybug Tools, honeybee-radiance-postprocess, class Results: names of files.
//   [2] NumPy, "numpy.lib.format": layout of .npy files.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "annual/annual.h"
#include "image/atomic_file.h"

namespace troffer {

struct HoneybeeGrid {
  std::string name;
  size_t sensors = 0;
};

// Arrays are written while sensors come; nothing remains in the folder without finish().
class HoneybeeFolder {
 public:
  // Throws EnvironmentError if a file cannot be written. Names that file systems may refuse are
  // changed for files, and kept as display names.
  HoneybeeFolder(std::string path, const std::vector<HoneybeeGrid>& grids, size_t hours);
  ~HoneybeeFolder();
  HoneybeeFolder(const HoneybeeFolder&) = delete;
  HoneybeeFolder& operator=(const HoneybeeFolder&) = delete;

  // Adds the hours of the next sensor, lx.
  void add(const HoursOfSensor& hours);
  // Writes the other files and makes all of them visible. Call it after the last sensor.
  void finish(const WeatherYear& year, const YearSkies& skies);

 private:
  struct GridFiles;

  std::string path_;
  std::vector<GridFiles> grids_;
  size_t grid_ = 0, sensor_ = 0;  // next one
};

// Returns the header of an array of little-endian floats, row by row [2].
std::string npy_header(size_t rows, size_t columns);

}  // namespace troffer
