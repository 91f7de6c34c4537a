#include "shadow/mask_points.h"

#include <array>
#include <bit>

namespace troffer {

namespace {

constexpr int side = 32;  // of the canvas: most_mask_rows
static_assert(side == int(most_mask_rows));

struct CanvasPoint {
  uint8_t k, j;
};

// Cells of the canvas along a Hilbert curve.
constexpr std::array<CanvasPoint, size_t(side* side)> hilbert_curve() {
  std::array<CanvasPoint, size_t(side * side)> curve{};
  for (int d = 0; d < side * side; ++d) {
    int x = 0, y = 0, t = d;
    for (int s = 1; s < side; s *= 2) {
      const int rx = 1 & (t / 2), ry = 1 & (t ^ rx);
      if (ry == 0) {
        if (rx == 1) {
          x = s - 1 - x;
          y = s - 1 - y;
        }
        const int swapped = x;
        x = y;
        y = swapped;
      }
      x += s * rx;
      y += s * ry;
      t /= 4;
    }
    curve[size_t(d)] = {uint8_t(x), uint8_t(y)};
  }
  return curve;
}
constexpr auto curve = hilbert_curve();

}  // namespace

void draw_points_compact(const MaskFrame& frame, const OpenSamples& s, uint32_t n, float start,
                         std::vector<Vec3>& points) {
  const Vec3d first = frame.first_sample() + frame.step_k() * double(s.shift.x) +
                      frame.step_j() * double(s.shift.y);
  uint32_t drawn = 0;
  float passed = 0;
  Vec3 last;
  bool is_any = false;
  // a curve over the smallest power of two that holds the canvas ends where that ends
  const auto rows = uint32_t(std::bit_ceil(unsigned(frame.lattice().rows)));
  for (uint32_t d = 0; d < rows * rows && drawn < n; ++d) {
    const CanvasPoint c = curve[d];
    if ((s.rows.row[c.j] >> c.k & 1u) == 0) continue;
    passed += weight_of(s.weights, c.k, c.j);
    if ((float(drawn) + start) / float(n) * s.open >= passed) continue;
    last = Vec3(first + frame.step_k() * double(c.k) + frame.step_j() * double(c.j));
    is_any = true;
    for (; drawn < n && (float(drawn) + start) / float(n) * s.open < passed; ++drawn)
      points.push_back(last);
  }
  for (; drawn < n && is_any; ++drawn) points.push_back(last);
}

void draw_points(const MaskFrame& frame, const OpenSamples& s, uint32_t n, float start,
                 std::vector<Vec3>& points) {
  const Vec3d first = frame.first_sample() + frame.step_k() * double(s.shift.x) +
                      frame.step_j() * double(s.shift.y);
  uint32_t drawn = 0;
  float row_start = 0;
  int last_k = -1, last_row = 0;
  const auto add = [&](int k, int row) {
    points.push_back(Vec3(first + frame.step_k() * double(k) + frame.step_j() * double(row)));
    ++drawn;
  };
  for (int row = 0; row < frame.lattice().rows && drawn < n; ++row) {
    const float row_end = row_start + s.open_by_row[row];
    uint32_t bits = s.rows.row[row];
    float passed = row_start;
    int k = -1;
    while (drawn < n) {
      const float target = (float(drawn) + start) / float(n) * s.open;
      if (target >= row_end) break;
      while (bits != 0 && passed <= target) {
        k = std::countr_zero(bits);
        passed += weight_of(s.weights, k, row);
        bits &= bits - 1;
      }
      if (k < 0) break;
      add(k, row);
    }
    if (k >= 0) {
      last_k = k;
      last_row = row;
    }
    row_start = row_end;
  }
  // Sums of floats may end short of the last target.
  while (drawn < n && last_k >= 0) add(last_k, last_row);
}

}  // namespace troffer
