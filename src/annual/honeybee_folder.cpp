#include "annual/honeybee_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"

namespace troffer {

namespace {

using HoneybeeJson = nlohmann::ordered_json;

constexpr const char* light_path = "__static_apertures__";  // [1]

// Letters, digits, '_', '-' and '.'; others become '_'.
std::string identifier(const std::string& name) {
  std::string id;
  for (const char c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '-' || c == '.';
    id += is_plain ? c : '_';
  }
  return id.empty() || id[0] == '.' ? "grid" + id : id;
}

std::string hour_text(double hour) {
  return fmt::format("{:.10g}", hour);
}

}  // namespace

struct HoneybeeFolder::GridFiles {
  std::string name, id;
  size_t sensors = 0;
  std::unique_ptr<AtomicFile> total, direct;
};

std::string npy_header(size_t rows, size_t columns) {
  std::string text =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  // Magic, version and length take 10 bytes; the whole is a multiple of 64 and ends in a line feed.
  while ((10 + text.size() + 1) % 64 != 0) text += ' ';
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += char(text.size() & 255);
  header += char(text.size() >> 8);
  return header + text;
}

HoneybeeFolder::HoneybeeFolder(std::string path, const std::vector<HoneybeeGrid>& grids,
                               size_t hours)
    : path_(std::move(path)) {
  const std::string arrays = path_ + "/" + light_path + "/default/";
  for (const char* part : {"total", "direct"}) {
    std::error_code error;
    std::filesystem::create_directories(arrays + part, error);
    if (error) throw EnvironmentError("cannot make the folder " + arrays + part);
  }
  std::set<std::string> used;
  for (const HoneybeeGrid& g : grids) {
    std::string id = identifier(g.name);
    for (int n = 2; !used.insert(id).second; ++n) id = fmt::format("{}_{}", identifier(g.name), n);
    GridFiles& files = grids_.emplace_back();
    files.name = g.name;
    files.id = id;
    files.sensors = g.sensors;
    files.total = std::make_unique<AtomicFile>(arrays + "total/" + id + ".npy");
    files.direct = std::make_unique<AtomicFile>(arrays + "direct/" + id + ".npy");
    for (AtomicFile* f : {files.total.get(), files.direct.get()})
      f->write(npy_header(g.sensors, hours));
  }
}

// Without finish(), the files vanish; so do folders that hold nothing else.
HoneybeeFolder::~HoneybeeFolder() {
  grids_.clear();
  std::error_code ignored;  // fails for folders that are not empty
  const std::string default_folder = path_ + "/" + light_path + "/default";
  for (const char* part : {"/total", "/direct", ""})
    std::filesystem::remove(default_folder + part, ignored);
  std::filesystem::remove(path_ + "/" + light_path, ignored);
  std::filesystem::remove(path_, ignored);
}

void HoneybeeFolder::add(const HoursOfSensor& hours) {
  while (sensor_ >= grids_[grid_].sensors) {
    ++grid_;
    sensor_ = 0;
  }
  const auto bytes = [](const std::vector<float>& v) {
    return std::string_view(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(float));
  };
  grids_[grid_].total->write(bytes(hours.total));
  grids_[grid_].direct->write(bytes(hours.sun));
  ++sensor_;
}

void HoneybeeFolder::finish(const WeatherYear& year, const YearSkies& skies) {
  HoneybeeJson info = HoneybeeJson::array(), states = HoneybeeJson::object();
  for (GridFiles& g : grids_) {
    g.total->commit();
    g.direct->commit();
    info.push_back({{"name", g.name},
                    {"identifier", g.id},
                    {"full_id", g.id},
                    {"group", ""},
                    {"count", g.sensors}});
    info.back()["light_path"] = HoneybeeJson::array({HoneybeeJson::array({light_path})});
    states[g.id] = HoneybeeJson::object();
  }
  const auto dump = [](const HoneybeeJson& json) {
    return json.dump(2, ' ', false, HoneybeeJson::error_handler_t::replace) + "\n";
  };
  std::string hours;
  for (const uint32_t step : skies.steps) hours += hour_text(year.steps[step].hour_of_year) + "\n";
  HoneybeeJson study{{"timestep", year.steps_per_hour}};
  for (const WeatherStep& s : year.steps) study["study_hours"].push_back(s.hour_of_year);
  write_file(path_ + "/sun-up-hours.txt", hours);
  write_file(path_ + "/study_info.json", study.dump() + "\n");
  write_file(path_ + "/grid_states.json", dump(states));
  write_file(path_ + "/grids_info.json", dump(info));
}

}  // namespace troffer
