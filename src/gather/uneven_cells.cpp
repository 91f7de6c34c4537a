#include "gather/uneven_cells.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/ablation.h"
#include "gather/uneven_light.h"

namespace troffer {

namespace {

constexpr size_t tries = 9;  // along either middle line of a cell: a lamp may be a narrow strip
constexpr size_t all_tries = 2 * tries;
// Heights of things above the surface that count, in widths of the cell. Below lower ones hardly
// any light arrives, and hardly any ray looks there.
constexpr float least_height = 0.125f, most_height = 0.5f;
constexpr float lift = 0.1f;  // height above the surface of sight tests, in widths

bool is_partly_covered(const Tracer& tracer, const CellOutline& cell) {
  const Vec3 &corner = cell.corners[0], u = cell.corners[1] - corner, v = cell.corners[3] - corner;
  const float width = std::max(length(u), length(v));
  std::array<Ray, all_tries> above;
  for (size_t i = 0; i < all_tries; ++i) {
    const float along = (float(i % tries) + 0.5f) / tries;
    const Vec3 on_line = i < tries ? u * along + v * 0.5f : u * 0.5f + v * along;
    above[i].origin = corner + on_line + cell.normal * cell.offset;
    above[i].direction = cell.normal;
    above[i].t_max = most_height * width;
  }
  std::array<Hit, all_tries> hits;
  tracer.closest(above, hits, Coherence::none, Meeting::no_panes);
  // A covered place counts if a free one beside it sees it. Otherwise the two lie on different
  // surfaces, or the covered one is inside a solid that stands there.
  std::vector<Ray> between;
  const auto look = [&](size_t i, size_t j) {
    const size_t covered = hits[i].is_valid() ? i : j, free = covered == i ? j : i;
    if (hits[free].is_valid() || !hits[covered].is_valid()) return;
    const float height = hits[covered].t;
    if (height < least_height * width) return;
    const Vec3 up = cell.normal * std::min(0.5f * height, lift * width);
    between.push_back(segment(above[free].origin + up, above[covered].origin + up));
  };
  for (size_t i = 0; i + 1 < all_tries; ++i)
    if (i + 1 != tries) look(i, i + 1);
  if (between.empty()) return false;
  std::vector<uint8_t> is_blocked(between.size());
  tracer.occluded(between, is_blocked);
  return std::count(is_blocked.begin(), is_blocked.end(), 0) > 0;
}

}  // namespace

CellMap::IsUneven uneven_cells(const PreparedScene& scene) {
  return [&scene](const CellOutline& cell, bool is_asked) {
    return (is_asked && !is_left_out<"covered cells">() && is_partly_covered(scene.tracer, cell)) ||
           (!is_left_out<"unevenly lit cells">() && is_unevenly_lit(scene, cell));
  };
}

}  // namespace troffer
