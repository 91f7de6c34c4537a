#include "import/recentre.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr double largest_reach = 1e9;  // as for triangles (triangle_check.h)
constexpr double usual_step = 100, far_step = 10;
constexpr double anchor_step = 1000;
// Slightly less than twice the box, and slightly more than half a step. Boxes and positions in
// round numbers are common, and their result must not depend on rounding.
constexpr double steps_per_box = 1.9, half_step = 0.501;
constexpr double coarse_resolution = 1e-3;

bool is_usable(const Vec3d& p) {
  const Vec3d reach = abs(p);  // the comparison is false for NaN
  return reach.x <= largest_reach && reach.y <= largest_reach && reach.z <= largest_reach;
}

double longest_side(const Boxd& box) {
  const Vec3d e = box.extent();
  return std::max({e.x, e.y, e.z});
}

// Returns the spacing of floats at the ends of the box.
double resolution(const Boxd& box) {
  const Vec3d reach = max(abs(box.lower), abs(box.upper));
  const auto end = float(std::max({reach.x, reach.y, reach.z}));
  return double(std::nextafter(end, std::numeric_limits<float>::infinity()) - end);
}

}  // namespace

void PlacedBounds::add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  if (!is_usable(a) || !is_usable(b) || !is_usable(c)) return;
  if (!(length_squared(cross(b - a, c - a)) > 0)) return;
  box_.grow(a);
  box_.grow(b);
  box_.grow(c);
}

void PlacedBounds::add_box(const Boxd& box) {
  if (is_usable(box.lower) && is_usable(box.upper)) box_.grow(box);
}

void PlacedBounds::add_ball(const Vec3d& centre, double radius) {
  if (!is_usable(centre - Vec3d{radius}) || !is_usable(centre + Vec3d{radius})) return;
  box_.grow(centre - Vec3d{radius});
  box_.grow(centre + Vec3d{radius});
}

Vec3d rounded_middle(const Boxd& box, double least_step) {
  if (box.is_empty()) return {};
  const double least = std::max(least_step, steps_per_box * longest_side(box));
  double step = 1;
  for (bool is_five = false; step < least; is_five = !is_five) step *= is_five ? 2 : 5;
  const Vec3d middle = box.centre();
  Vec3d rounded;
  for (size_t a = 0; a < 3; ++a) rounded[a] = std::floor(middle[a] / step + half_step) * step + 0.0;
  return rounded;
}

// A finer step than in the test keeps the remaining coordinates small. Large ones would cost digits
// and move measuring points off their surfaces.
Vec3d choose_origin(const Boxd& box) {
  const double side = longest_side(box);
  if (rounded_middle(box, usual_step * std::min(1.0, side)) == Vec3d{}) return {};
  return rounded_middle(box, far_step * std::min(1.0, side));
}

Scene import_recentred(const std::function<void(Scene& scene, PlacedBounds& bounds)>& import,
                       ImageUse images) {
  Scene empty;
  if (images == ImageUse::left_out) empty.skipped_image_bytes = 0;
  Scene scene = empty;
  PlacedBounds bounds;
  import(scene, bounds);
  const Vec3d origin = choose_origin(bounds.box());
  if (origin != Vec3d{}) {
    scene = empty;
    scene.origin = origin;
    bounds = PlacedBounds();
    import(scene, bounds);
  }
  if (bounds.box().is_empty()) return scene;
  const double coarse = resolution(bounds.box());
  if (coarse > coarse_resolution)
    scene.warnings.add(
        fmt::format("the scene is {:.0f} across, too large for single precision: positions at its "
                    "ends are rounded to steps of {:.2g}",
                    longest_side(bounds.box()), coarse));
  return scene;
}

void set_positions(AnchoredMesh& mesh, const std::vector<Vec3d>& positions) {
  constexpr size_t piece = size_t(1) << 16;
  std::vector<Boxd> boxes(positions.size() / piece + 1);
  parallel_pieces(positions.size(), piece, [&](size_t first, size_t end) {
    Boxd box;
    for (size_t i = first; i < end; ++i)
      if (is_usable(positions[i])) box.grow(positions[i]);
    boxes[first / piece] = box;
  });
  Boxd box;
  for (const Boxd& part : boxes) box.grow(part);
  const Vec3d anchor = mesh.anchor = rounded_middle(box, anchor_step);
  std::vector<Vec3>& out = mesh.mesh.positions;
  out.resize(positions.size());
  parallel_pieces(positions.size(), piece, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) out[i] = Vec3(positions[i] - anchor);
  });
}

}  // namespace troffer
