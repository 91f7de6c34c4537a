// Chooses the sizes of sheets and elements and the triangles to join (meshing.h).
#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/units.h"
#include "radiosity/meshing_parts.h"

namespace troffer {

namespace {

constexpr double size_step = 1.3;  // growth factor of a size that exceeds its bound

double total_area(const BaseGeometry& g, const std::vector<uint32_t>& same_as) {
  double sum = 0;
  for (uint32_t i = 0; i < g.triangles.size(); ++i) {
    const BaseTriangle& t = g.triangles[i];
    if (t.is_degenerate || same_as[i] != i) continue;
    const Vec3d a(g.positions[t.vertices[0]]);
    sum += 0.5 * length(cross(Vec3d(g.positions[t.vertices[1]]) - a,
                              Vec3d(g.positions[t.vertices[2]]) - a));
  }
  return sum;
}

double longest_edge(const BaseGeometry& g, const BaseTriangle& t) {
  double longest = 0;
  for (size_t k = 0; k < 3; ++k)
    longest = std::max(
        longest, double(length(g.positions[t.vertices[(k + 1) % 3]] - g.positions[t.vertices[k]])));
  return longest;
}

// Returns the number of fragments of triangles longer than `size`, which are cut.
size_t count_cut(const BaseGeometry& g, const std::vector<uint32_t>& same_as,
                 const std::vector<double>& lengths, double size, size_t limit) {
  size_t count = 0;
  for (uint32_t i = 0; i < g.triangles.size() && count < limit; ++i) {
    const BaseTriangle& t = g.triangles[i];
    if (t.is_degenerate || same_as[i] != i || lengths[i] <= size) continue;
    count += count_fragments(g, i, size, limit - count);
  }
  return count;
}

// Increases `size` in steps to at least a hundredth of the size at which `most` pieces cover the
// area. The loop in plan_joining tries larger sizes one by one. A file may ask for 1e-38 m.
double within_reach(double size, double area, uint32_t most) {
  constexpr double pieces_short = 1e4;
  const double least = std::sqrt(area / (pieces_short * std::max(most, 1u)));
  while (size < least) size *= size_step;
  return size;
}

}  // namespace

JoinPlan plan_joining(const BaseGeometry& g, const std::vector<uint32_t>& same_as,
                      const MeshingOptions& options) {
  constexpr double wanted_elements = 4000;
  constexpr int strict_rounds = 8, rounds = 60;
  const size_t n = g.triangles.size();
  const double area = total_area(g, same_as);
  const double automatic = std::max(1e-6, std::sqrt(2 * area / wanted_elements));
  double element = options.element_size > 0 ? double(options.element_size) : automatic;
  double patch = options.patch_size > 0 ? double(options.patch_size) : 4 * element;
  double angle = double(options.join_angle_deg);
  std::vector<double> lengths(n, 0);
  for (size_t i = 0; i < n; ++i)
    if (!g.triangles[i].is_degenerate) lengths[i] = longest_edge(g, g.triangles[i]);
  Boxd box;
  for (const Vec3& p : g.positions)
    if (is_finite(p)) box.grow(Vec3d(p));
  const double everything = 4 * box.diagonal();  // cell size at which everything in reach is joined
  const Adjacency adjacency(g);
  const std::vector<uint32_t> no_group(n, 0);
  const auto small = [&](double size) {
    std::vector<uint8_t> is_small(n);
    for (uint32_t i = 0; i < n; ++i)
      is_small[i] = !g.triangles[i].is_degenerate && same_as[i] == i && lengths[i] <= size;
    return is_small;
  };
  const double wanted = element;
  const double first_element = element = within_reach(element, area, options.max_elements);
  const double first_patch = patch = within_reach(patch, area, options.max_sheets);
  JoinPlan plan;
  for (int round = 0;; ++round) {
    if (round == strict_rounds) {  // larger sizes did not suffice: restart with loose rules
      element = first_element;
      patch = first_patch;
    }
    patch = std::max(patch, element);
    const JoinLimits whole{patch, std::cos(rad_from_deg(angle)), round >= strict_rounds};
    const JoinLimits part{element, whole.cos_angle, whole.is_loose};
    const size_t max_sheets = options.max_sheets, max_elements = options.max_elements;
    const size_t cut_sheets = count_cut(g, same_as, lengths, patch, max_sheets + 1);
    const size_t cut_elements = count_cut(g, same_as, lengths, element, max_elements + 1);
    const bool is_last = round >= rounds || (round >= strict_rounds && element > everything);
    bool fits = is_last || (cut_sheets <= max_sheets && cut_elements <= max_elements);
    if (fits) {
      plan.sheets = join_triangles(g, adjacency, small(patch), no_group, whole);
      plan.elements = join_triangles(g, adjacency, small(element), plan.sheets.label, part);
      const bool sheets_fit = plan.sheets.count + cut_sheets <= max_sheets;
      const bool elements_fit = plan.elements.count + cut_elements <= max_elements;
      if (is_last || (sheets_fit && elements_fit)) break;
      angle = std::min(75.0, angle * 1.6);
      if (!sheets_fit) patch *= size_step;
      if (!elements_fit) element *= size_step;
      continue;
    }
    if (cut_sheets > max_sheets) patch *= size_step;
    if (cut_elements > max_elements) element *= size_step;
    if (round < strict_rounds) --round;  // only sizes changed: keep the joining rules
  }
  plan.set_sizes(element, patch, angle, element / wanted);
  return plan;
}

}  // namespace troffer
