// A folder as `troffer annual` leaves it, with numbers that tests can tell apart.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "../import/temp_folder.h"
#include "annual/honeybee_folder.h"
#include "image/atomic_file.h"

namespace troffer::test {

// Two days by hours. The sun is up from 8 to 16 h: 16 hours. Grids "desk" with three sensors and
// "hall" with two. The group South has two states and lights the desk alone; its state is 1 in odd
// hours. Other windows light both grids.
class StoredFolder {
 public:
  static constexpr size_t hours = 16, sensors = 5;

  StoredFolder() {
    year_.steps_per_hour = 1;
    for (int h = 0; h < 48; ++h) {
      WeatherStep& s = year_.steps.emplace_back();
      s.hour_of_year = h + 0.5;
      if (h % 24 >= 8 && h % 24 < 16) skies_.steps.push_back(uint32_t(h));
    }
    StateSchedule schedule(2, hours);
    for (size_t h = 1; h < hours; h += 2) schedule.of(1)[h] = 1;
    {
      HoneybeeFolder files(path() + "/honeybee", {{"desk", 3}, {"hall", 2}},
                           {{static_path, 1}, {"South", 2}}, hours);
      for (size_t s = 0; s < sensors; ++s) files.add(hours_of(s));
      files.finish(year_, skies_, schedule);
    }
    write("annual.json", R"({"scene": "rooms/two.gltf",
      "weather": {"place": "Nowhere", "zone_hours": 1.0},
      "window_groups": [{"name": "South", "states": [{"name": "up"}, {"name": "down"}]}]})");
    std::string table = "grid,x,y,z,nx,ny,nz,da\n";
    for (size_t s = 0; s < sensors; ++s)
      table += fmt::format("\"{}\",{},0.5,1,0,0,1,50\n", s < 3 ? "desk" : "hall", s);
    write("metrics.csv", table);
  }

  std::string path() const { return folder_.path(""); }
  std::string file(const std::string& name) const { return path() + "/" + name; }
  void write(const std::string& name, const std::string& text) const {
    write_file(file(name), text);
  }

  // Illuminance by other windows, and by South in a state. Direct light is a tenth of it.
  static float beside(size_t sensor, size_t hour) { return float(1000 * (sensor + 1) + hour); }
  static float south(size_t sensor, size_t hour, size_t state) {
    return sensor < 3 ? float(100000 * (state + 1) + 10 * sensor) + float(hour) / 8 : 0;
  }
  static float error(size_t sensor, size_t hour) { return float(sensor) + float(hour) / 64; }

 private:
  static HoursOfSensor hours_of(size_t s) {
    HoursOfSensor h;
    h.states.resize(3);
    for (size_t i = 0; i < hours; ++i) {
      h.error.push_back(error(s, i));
      const float lx[] = {beside(s, i), south(s, i, 0), south(s, i, 1)};
      for (size_t k = 0; k < 3; ++k) {
        h.states[k].total.push_back(lx[k]);
        h.states[k].sun.push_back(lx[k] / 16);
      }
    }
    return h;
  }

  TempFolder folder_;
  WeatherYear year_;
  YearSkies skies_{{}, {ReinhartSky(1), {}}, {ReinhartSky(1), {}}, {}, {}, {}};
};

}  // namespace troffer::test
