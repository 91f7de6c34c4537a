#include "app/grid_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/file.h"
#include "lighting/option_text.h"
#include "report/find_surfaces.h"

namespace troffer {

namespace {

constexpr size_t most_points = 1'000'000;

struct Grid {
  std::string node;
  double height = 0, spacing = 0;  // m; spacing 0: by EN 12464-1
};

// Removes a number after the last comma from the text and returns it. Names may contain commas.
std::optional<double> take_number(std::string& text) {
  const size_t comma = text.rfind(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto number = parse_number(text.substr(comma + 1));
  if (number) text.resize(comma);
  return number;
}

Grid parse_grid(const std::string& text) {
  Grid g;
  g.node = text;
  const auto last = take_number(g.node);
  const auto first = last ? take_number(g.node) : std::nullopt;
  g.height = first.value_or(last.value_or(0));
  g.spacing = first ? *last : 0;
  if (g.node.empty()) throw UsageError("--grid: '" + text + "' is not NODE[,HEIGHT[,SPACING]]");
  if (std::abs(g.height) > 1000)
    throw UsageError(fmt::format("--grid: a height of {} m is more than 1000 m", g.height));
  if (first && !(g.spacing >= 1e-3 && g.spacing <= 1e5))
    throw UsageError(
        fmt::format("--grid: a spacing of {} m is not between .001 and 100000 m", g.spacing));
  return g;
}

FoundSurfaces surfaces_of(const PreparedScene& scene, const Vec3& up, const Grid& g,
                          double border) {
  SurfaceRequest request;
  request.node = g.node;
  request.lift = g.height;
  request.border = border;
  try {
    return asked_surfaces(scene, normalize(Vec3d(up)), {request}, "");
  } catch (const UsageError& error) {
    std::string text = error.what();
    const std::string other = "--surface";
    if (text.starts_with(other)) text.replace(0, other.size(), "--grid");
    throw UsageError(text);
  }
}

// Adds a sensor grid of the file.
void add(const SensorGrid& grid, PointList& list) {
  if (grid.positions.size() > most_points - std::min(most_points, list.points.size()))
    throw UsageError("--grid: more than a million points");
  for (size_t i = 0; i < grid.positions.size(); ++i) {
    list.points.push_back({grid.positions[i], grid.directions[i]});
    list.surfaces.push_back(grid.name);
  }
}

// Adds the sensor grids of that name, or of the room of that name. Returns false if there are none.
bool add_named(const Scene& scene, const std::string& name, PointList& list) {
  bool is_any = false;
  for (const bool by_room : {false, true}) {
    for (const SensorGrid& grid : scene.grids) {
      if ((by_room ? grid.room : grid.name) != name) continue;
      add(grid, list);
      is_any = true;
    }
    if (is_any) return true;
  }
  return false;
}

}  // namespace

bool may_have_sensor_grids(const std::string& file) {
  const std::string ending = lower_case_ending(without_gz(file));
  return ending == "hbjson" || ending == "json";
}

void add_sensor_grids(const Scene& scene, PointList& list) {
  if (scene.grids.empty())
    throw UsageError(
        "measure: the model has no sensor grids: give --points FILE.csv or --grid NODE");
  for (const SensorGrid& grid : scene.grids) add(grid, list);
}

void add_grids(const PreparedScene& scene, const GridChoice& choice, const Vec3& up,
               PointList& list) {
  if (choice.grids.empty()) return;
  list.surfaces.resize(list.points.size());
  for (const std::string& text : choice.grids) {
    if (add_named(scene.scene, text, list)) continue;
    const Grid g = parse_grid(text);
    for (AssessedSurface s : surfaces_of(scene, up, g, choice.border).surfaces) {
      s.spacing = g.spacing;
      const SurfaceGrid grid = grid_of(s);
      if (grid.points.size() > most_points - list.points.size())
        throw UsageError("--grid: more than a million points");
      for (const GridPoint& p : grid.points) {
        list.points.push_back({p.position, Vec3(s.normal()) + Vec3{0}});  // no negative zeros
        list.surfaces.push_back(s.name);
      }
    }
  }
}

}  // namespace troffer
