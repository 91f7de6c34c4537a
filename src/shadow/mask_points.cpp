#include "shadow/mask_points.h"

#include <bit>

namespace troffer {

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
