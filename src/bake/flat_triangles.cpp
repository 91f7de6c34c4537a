#include "bake/flat_triangles.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr double most_shared = 1e-3;
// A triangle that covers more cells is compared with all others.
constexpr double most_cells = 4096;

// True if all of `b` lies on the outer side of an edge of `a`.
bool has_separating_edge(const FlatTriangle& a, const FlatTriangle& b) {
  const double turn = doubled_area(a) < 0 ? -1 : 1;
  for (size_t k = 0; k < 3; ++k) {
    const Vec2d from = a[k], way = a[(k + 1) % 3] - from;
    bool is_outside = true;
    for (const Vec2d& p : b) {
      const Vec2d d = p - from;
      is_outside = is_outside && turn * (way.x * d.y - way.y * d.x) <= 0;
    }
    if (is_outside) return true;
  }
  return false;
}

}  // namespace

void FlatPolygon::cut(const Vec2d& normal, double distance) {
  FlatPolygon out;
  for (size_t i = 0; i < size; ++i) {
    const Vec2d a = corners[i], b = corners[(i + 1) % size];
    const double of_a = normal.x * a.x + normal.y * a.y - distance;
    const double of_b = normal.x * b.x + normal.y * b.y - distance;
    if (of_a <= 0 && out.size < out.corners.size()) out.corners[out.size++] = a;
    if ((of_a < 0 && of_b > 0) || (of_a > 0 && of_b < 0))
      if (out.size < out.corners.size())
        out.corners[out.size++] = a + (b - a) * (of_a / (of_a - of_b));
  }
  *this = out;
}

double FlatPolygon::area() const {
  double sum = 0;
  for (size_t i = 2; i < size; ++i) sum += doubled_area({corners[0], corners[i - 1], corners[i]});
  return std::abs(sum) / 2;
}

FlatPolygon in_square(const FlatTriangle& triangle, double x0, double y0, double x1, double y1) {
  FlatPolygon p(triangle);
  p.cut({-1, 0}, -x0);
  p.cut({1, 0}, x1);
  p.cut({0, -1}, -y0);
  p.cut({0, 1}, y1);
  return p;
}

bool overlap(const FlatTriangle& a, const FlatTriangle& b) {
  if (has_separating_edge(a, b) || has_separating_edge(b, a)) return false;
  FlatPolygon common(a);
  const double turn = doubled_area(b) < 0 ? -1 : 1;
  for (size_t k = 0; k < 3; ++k) {
    const Vec2d from = b[k], way = (b[(k + 1) % 3] - from) * turn;
    const Vec2d outward{way.y, -way.x};
    common.cut(outward, outward.x * from.x + outward.y * from.y);
  }
  const double smaller = std::min(std::abs(doubled_area(a)), std::abs(doubled_area(b))) / 2;
  return common.area() > most_shared * smaller;
}

bool LaidTriangles::add(const FlatTriangle& t) {
  Vec2d lower = t[0], upper = t[0];
  for (const Vec2d& p : t) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
  }
  const double x0 = std::floor(lower.x / cell_), x1 = std::floor(upper.x / cell_);
  const double y0 = std::floor(lower.y / cell_), y1 = std::floor(upper.y / cell_);
  const bool is_everywhere =
      !((x1 - x0 + 1) * (y1 - y0 + 1) <= most_cells) || !(std::abs(x0) < 1e9 && std::abs(y0) < 1e9);
  const auto is_over = [&](uint32_t i) { return overlap(all_[i], t); };
  if (is_everywhere) {
    for (uint32_t i = 0; i < all_.size(); ++i)
      if (is_over(i)) return false;
    everywhere_.push_back(uint32_t(all_.size()));
    all_.push_back(t);
    return true;
  }
  if (std::any_of(everywhere_.begin(), everywhere_.end(), is_over)) return false;
  std::vector<uint64_t> keys;
  for (double y = y0; y <= y1; ++y)
    for (double x = x0; x <= x1; ++x)
      keys.push_back(uint64_t(uint32_t(int32_t(x))) << 32 | uint32_t(int32_t(y)));
  for (const uint64_t key : keys) {
    const auto found = cells_.find(key);
    if (found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), is_over))
      return false;
  }
  for (const uint64_t key : keys) cells_[key].push_back(uint32_t(all_.size()));
  all_.push_back(t);
  return true;
}

}  // namespace troffer
