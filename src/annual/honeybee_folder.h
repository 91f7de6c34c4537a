// Writes hourly illuminance in the layout of Honeybee's annual daylight results, which Ladybug
// Tools post-process: grids_info.json, sun-up-hours.txt, and one array per grid, light path and
// state.
//
// References: [1] Ladybug Tools, honeybee-radiance-postprocess, class Results: names of files.
//   [2] NumPy, "numpy.lib.format": layout of .npy files.
//   [3] The same package, command annual-daylight-npy-to-ill: layout of .ill files.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "annual/annual.h"
#include "image/atomic_file.h"

namespace troffer {

struct HoneybeeGrid {
  std::string name;
  size_t sensors = 0;
};
struct HoneybeePath {
  std::string name;
  size_t states = 1;
};
enum class ArrayFormat { npy, npy_and_ill };

// Writes arrays as sensors are added. The destructor removes them unless finish() was called. A
// light path that brings no light to a grid gets no arrays for that grid.
class HoneybeeFolder {
 public:
  // Throws EnvironmentError if a file cannot be written. Names that file systems may refuse are
  // changed for files, and kept as display names.
  HoneybeeFolder(std::string path, const std::vector<HoneybeeGrid>& grids,
                 const std::vector<HoneybeePath>& paths, size_t hours,
                 ArrayFormat format = ArrayFormat::npy);
  ~HoneybeeFolder();
  HoneybeeFolder(const HoneybeeFolder&) = delete;
  HoneybeeFolder& operator=(const HoneybeeFolder&) = delete;

  // Adds the hours of the next sensor, lx.
  void add(const HoursOfSensor& hours);
  // Writes the other files and makes all of them visible. Call it after the last sensor. schedule:
  // one state per path and hour.
  void finish(const WeatherYear& year, const YearSkies& skies, const StateSchedule& schedule);

 private:
  struct GridFiles;
  struct PathNames;

  void open(GridFiles& grid) const;
  std::string folder_of(const PathNames& path, size_t state) const;
  std::string schedule_json(const WeatherYear& year, const YearSkies& skies,
                            const StateSchedule& schedule) const;

  std::string path_;
  size_t hours_;
  ArrayFormat format_;
  std::vector<PathNames> paths_;
  std::vector<GridFiles> grids_;
  size_t grid_ = 0, sensor_ = 0;  // next one
};

// Returns names of files for the names of grids, or of light paths: letters, digits, '_', '-' and
// '.' stay, equal names get numbers. Their order matters.
std::vector<std::string> file_identifiers(const std::vector<std::string>& names);
// Returns the header of an array of little-endian floats, row by row [2].
std::string npy_header(size_t rows, size_t columns);
// Returns one row of a text array: numbers in exponential notation between tabs [3].
std::string ill_row(std::span<const float> values);

}  // namespace troffer
