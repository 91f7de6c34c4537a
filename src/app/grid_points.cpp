#include "app/grid_points.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
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

}  // namespace

void add_grids(const PreparedScene& scene, const GridChoice& choice, const Vec3& up,
               PointList& list) {
  if (choice.grids.empty()) return;
  list.surfaces.resize(list.points.size());
  for (const std::string& text : choice.grids) {
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
