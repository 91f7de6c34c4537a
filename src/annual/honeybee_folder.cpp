#include "annual/honeybee_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"

namespace troffer {

namespace {

using HoneybeeJson = nlohmann::ordered_json;

constexpr const char* part_names[] = {"total", "direct"};
constexpr const char* errors = "/standard_error";  // our own addition to the layout

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

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw EnvironmentError("cannot make the folder " + path);
}

std::string hour_text(double hour) {
  return fmt::format("{:.10g}", hour);
}

}  // namespace

// One array in all its formats, written row by row.
class ArrayFiles {
 public:
  // stem: path without the ending.
  ArrayFiles(const std::string& stem, size_t rows, size_t columns, ArrayFormat format)
      : npy_(std::make_unique<AtomicFile>(stem + ".npy")) {
    npy_->write(npy_header(rows, columns));
    if (format == ArrayFormat::npy_and_ill) ill_ = std::make_unique<AtomicFile>(stem + ".ill");
  }
  void add_row(const std::vector<float>& values) {
    npy_->write(std::string_view(reinterpret_cast<const char*>(values.data()),
                                 values.size() * sizeof(float)));
    if (ill_) ill_->write(ill_row(values));
  }
  void commit() {
    npy_->commit();
    if (ill_) ill_->commit();
  }

 private:
  std::unique_ptr<AtomicFile> npy_, ill_;
};

// Files of one path and state.
struct StateFiles {
  ArrayFiles total, direct;
};

struct HoneybeeFolder::PathNames {
  std::string name, id;
  std::vector<std::string> states;  // names of folders [1]
};

struct HoneybeeFolder::GridFiles {
  std::string name, id;
  size_t sensors = 0;
  std::vector<std::vector<StateFiles>> files;  // path by path
  std::vector<bool> has_light;                 // per path
  std::unique_ptr<ArrayFiles> error;
};

std::vector<std::string> file_identifiers(const std::vector<std::string>& names) {
  std::set<std::string> used;
  std::vector<std::string> ids;
  for (const std::string& name : names) {
    std::string id = identifier(name);
    for (int n = 2; !used.insert(id).second; ++n) id = fmt::format("{}_{}", identifier(name), n);
    ids.push_back(id);
  }
  return ids;
}

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

std::string ill_row(std::span<const float> values) {
  fmt::memory_buffer row;
  for (size_t i = 0; i < values.size(); ++i)
    fmt::format_to(std::back_inserter(row), "{:.7e}{}", values[i],
                   i + 1 < values.size() ? '\t' : '\n');
  return fmt::to_string(row);
}

HoneybeeFolder::HoneybeeFolder(std::string path, const std::vector<HoneybeeGrid>& grids,
                               const std::vector<HoneybeePath>& paths, size_t hours,
                               ArrayFormat format)
    : path_(std::move(path)), hours_(hours), format_(format) {
  const auto names_of = [](const auto& list) {
    std::vector<std::string> names;
    for (const auto& item : list) names.push_back(item.name);
    return names;
  };
  const std::vector<std::string> path_ids = file_identifiers(names_of(paths));
  const std::vector<std::string> grid_ids = file_identifiers(names_of(grids));
  for (const HoneybeePath& p : paths) {
    PathNames& names = paths_.emplace_back();
    names.name = p.name;
    names.id = path_ids[paths_.size() - 1];
    for (size_t s = 0; s < p.states; ++s) {
      names.states.push_back(p.name == static_path ? "default" : fmt::format("{}_{}", s, names.id));
      for (const char* part : part_names) make_folder(folder_of(names, s) + part);
    }
  }
  make_folder(path_ + errors);
  for (const HoneybeeGrid& g : grids) {
    GridFiles& files = grids_.emplace_back();
    files.name = g.name;
    files.id = grid_ids[grids_.size() - 1];
    files.sensors = g.sensors;
  }
}

std::string HoneybeeFolder::folder_of(const PathNames& path, size_t state) const {
  return path_ + "/" + path.id + "/" + path.states[state] + "/";
}

void HoneybeeFolder::open(GridFiles& grid) const {
  grid.has_light.assign(paths_.size(), false);
  grid.error = std::make_unique<ArrayFiles>(path_ + errors + "/" + grid.id, grid.sensors, hours_,
                                            ArrayFormat::npy);
  for (const PathNames& p : paths_) {
    std::vector<StateFiles>& files = grid.files.emplace_back();
    for (size_t s = 0; s < p.states.size(); ++s) {
      const auto open_part = [&](const char* part) {
        return ArrayFiles(folder_of(p, s) + part + "/" + grid.id, grid.sensors, hours_, format_);
      };
      files.push_back({open_part(part_names[0]), open_part(part_names[1])});
    }
  }
}

// Without finish(), the files vanish; so do folders that hold nothing else.
HoneybeeFolder::~HoneybeeFolder() {
  grids_.clear();
  std::error_code ignored;  // fails for folders that are not empty
  for (const PathNames& p : paths_) {
    for (size_t s = 0; s < p.states.size(); ++s)
      for (const char* part : {part_names[0], part_names[1], ""})
        std::filesystem::remove(folder_of(p, s) + part, ignored);
    for (const std::string& state : p.states)
      std::filesystem::remove(path_ + "/" + p.id + "/" + state, ignored);
    std::filesystem::remove(path_ + "/" + p.id, ignored);
  }
  std::filesystem::remove(path_ + errors, ignored);
  std::filesystem::remove(path_, ignored);
}

void HoneybeeFolder::add(const HoursOfSensor& hours) {
  while (sensor_ >= grids_[grid_].sensors) {
    ++grid_;
    sensor_ = 0;
  }
  GridFiles& grid = grids_[grid_];
  if (grid.files.empty()) open(grid);
  grid.error->add_row(hours.error);
  size_t k = 0;
  for (size_t p = 0; p < paths_.size(); ++p)
    for (StateFiles& f : grid.files[p]) {
      const HoursOfState& state = hours.states[k++];
      f.total.add_row(state.total);
      f.direct.add_row(state.sun);
      grid.has_light[p] = grid.has_light[p] || std::any_of(state.total.begin(), state.total.end(),
                                                           [](float lx) { return lx > 0; });
    }
  ++sensor_;
}

// State of every group in every hour of a year [1]. Hours without daylight show state 0.
std::string HoneybeeFolder::schedule_json(const WeatherYear& year, const YearSkies& skies,
                                          const StateSchedule& schedule) const {
  HoneybeeJson json = HoneybeeJson::object();
  for (size_t p = 0; p < paths_.size(); ++p) {
    if (paths_[p].name == static_path) continue;
    std::vector<int> states(year.steps.size(), 0);
    for (size_t h = 0; h < skies.hours(); ++h) states[skies.steps[h]] = schedule.of(p)[h];
    const bool is_static =
        std::all_of(states.begin(), states.end(), [&](int s) { return s == states[0]; });
    json[paths_[p].id] = {
        {"identifier", paths_[p].id}, {"schedule", states}, {"is_static", is_static}};
  }
  return json.dump() + "\n";
}

void HoneybeeFolder::finish(const WeatherYear& year, const YearSkies& skies,
                            const StateSchedule& schedule) {
  HoneybeeJson info = HoneybeeJson::array(), states = HoneybeeJson::object();
  for (GridFiles& g : grids_) {
    HoneybeeJson light_paths = HoneybeeJson::array(), dynamic = HoneybeeJson::object();
    const bool is_dark =
        std::find(g.has_light.begin(), g.has_light.end(), true) == g.has_light.end();
    for (size_t p = 0; p < paths_.size(); ++p) {
      if (!g.has_light[p] && !(is_dark && p == 0)) continue;
      for (StateFiles& f : g.files[p]) {
        f.total.commit();
        f.direct.commit();
      }
      light_paths.push_back(HoneybeeJson::array({paths_[p].id}));
      if (paths_[p].name != static_path) dynamic[paths_[p].id] = paths_[p].states;
    }
    g.error->commit();
    info.push_back({{"name", g.name},
                    {"identifier", g.id},
                    {"full_id", g.id},
                    {"group", ""},
                    {"count", g.sensors}});
    info.back()["light_path"] = std::move(light_paths);
    states[g.id] = std::move(dynamic);
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
  if (paths_.size() > 1 || paths_[0].name != static_path)
    write_file(path_ + "/dynamic_schedule.json", schedule_json(year, skies, schedule));
  write_file(path_ + "/grid_states.json", dump(states));
  write_file(path_ + "/grids_info.json", dump(info));
}

}  // namespace troffer
