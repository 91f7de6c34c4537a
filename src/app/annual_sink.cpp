#include "app/annual_sink.h"

#include <sys/resource.h>

namespace troffer {

namespace {

constexpr float bright_lx = 300;  // AnnualGrid::share_300

// Adds a sensor's hours to the means of its grid.
void add_to_grid(const HoursOfSensor& hours, AnnualGrid& grid) {
  grid.mean_lx.resize(hours.total.size(), 0);
  grid.share_300.resize(hours.total.size(), 0);
  const float share = 1.0f / float(grid.count);
  for (size_t h = 0; h < hours.total.size(); ++h) {
    grid.mean_lx[h] += share * hours.total[h];
    grid.share_300[h] += hours.total[h] >= bright_lx ? 100 * share : 0;
  }
}

// Allows as many open files as the system does: arrays of all grids, groups and states stay open
// until the end.
void allow_open_files() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // a failure shows when a file cannot be opened
}

}  // namespace

void AnnualSink::take(size_t sensor, const HoursOfSensor& hours) {
  if (!arrays_) open(hours.total.size());
  const size_t first_eye = grids_.back().first + grids_.back().count;
  if (sensor >= first_eye) {
    EyeYear& eye = eyes_[sensor - first_eye];
    eye.vertical_lx = hours.total;
    eye.dgp = hours.dgp;
    return;
  }
  while (sensor >= grids_[grid_].first + grids_[grid_].count) ++grid_;
  add_to_grid(hours, grids_[grid_]);
  dimming_.add(sensor, hours.total);
  arrays_->add(hours);
}

void AnnualSink::open(size_t hours) {
  allow_open_files();
  std::vector<HoneybeeGrid> named;
  for (const AnnualGrid& g : grids_) named.push_back({g.name, g.count});
  std::vector<HoneybeePath> paths;
  for (const LightPath& p : paths_) paths.push_back({p.name, p.states.size()});
  arrays_ = std::make_unique<HoneybeeFolder>(folder_, named, paths, hours, format_);
}

}  // namespace troffer
