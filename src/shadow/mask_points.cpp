#include "shadow/mask_points.h"

#include <array>
#include <bit>

#include "base/random.h"

namespace troffer {

namespace {

constexpr int canvas_side = 32;  // side of the canvas
static_assert(canvas_side == int(most_mask_rows));

struct CanvasPoint {
  uint8_t k, j;
};

// Returns the cells of the canvas in the order of a Hilbert curve.
constexpr std::array<CanvasPoint, size_t(canvas_side* canvas_side)> hilbert_curve() {
  std::array<CanvasPoint, size_t(canvas_side * canvas_side)> curve{};
  for (int d = 0; d < canvas_side * canvas_side; ++d) {
    int x = 0, y = 0, t = d;
    for (int s = 1; s < canvas_side; s *= 2) {
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

// Positions in the open weight at which points are drawn, in ascending order.
class Targets {
 public:
  Targets(uint32_t n, uint64_t random, float open)
      : random_(random), part_(open / float(n)), n_(n) {
    set();
  }
  bool is_done() const { return drawn_ == n_; }
  float next() const { return next_; }
  void advance() {
    ++drawn_;
    set();
  }

 private:
  void set() {
    next_ = (float(drawn_) + unit_float(uint32_t(mix64(random_ + drawn_) >> 32))) * part_;
  }

  uint64_t random_;
  float part_, next_ = 0;
  uint32_t n_, drawn_ = 0;
};

// World position of canvas (0,0), and the steps to its neighbours.
struct Canvas {
  Vec3d first, step_k, step_j;

  Canvas(const MaskFrame& frame, const Vec2& shift)
      : first(frame.first_sample() + frame.step_k() * double(shift.x) +
              frame.step_j() * double(shift.y)),
        step_k(frame.step_k()),
        step_j(frame.step_j()) {}
  Vec3 at(int k, int j) const { return Vec3(first + step_k * double(k) + step_j * double(j)); }
};

}  // namespace

void draw_points(const MaskFrame& frame, const OpenSamples& s, uint32_t n, uint64_t random,
                 std::vector<Vec3>& points) {
  const Canvas canvas(frame, s.shift);
  Targets targets(n, random, s.open);
  float row_start = 0;
  int last_k = -1, last_row = 0;
  for (int row = 0; row < frame.lattice().rows && !targets.is_done(); ++row) {
    const float row_end = row_start + s.open_by_row[row];
    uint32_t bits = s.rows.row[row];
    float passed = row_start;
    int k = -1;
    for (; !targets.is_done() && targets.next() < row_end; targets.advance()) {
      while (bits != 0 && passed <= targets.next()) {
        k = std::countr_zero(bits);
        passed += weight_of(s.weights, k, row);
        bits &= bits - 1;
      }
      if (k < 0) break;
      points.push_back(canvas.at(k, row));
    }
    if (k >= 0) {
      last_k = k;
      last_row = row;
    }
    row_start = row_end;
  }
  // Rounding of the sums may leave the last targets unreached.
  for (; !targets.is_done() && last_k >= 0; targets.advance())
    points.push_back(canvas.at(last_k, last_row));
}

void draw_points_compact(const MaskFrame& frame, const OpenSamples& s, uint32_t n, uint64_t random,
                         std::vector<Vec3>& points) {
  const Canvas canvas(frame, s.shift);
  Targets targets(n, random, s.open);
  float passed = 0;
  const CanvasPoint* last = nullptr;
  // The first rows² cells of the curve fill the smallest power of two that holds the canvas.
  const auto rows = uint32_t(std::bit_ceil(unsigned(frame.lattice().rows)));
  for (uint32_t d = 0; d < rows * rows && !targets.is_done(); ++d) {
    const CanvasPoint& c = curve[d];
    if ((s.rows.row[c.j] >> c.k & 1u) == 0) continue;
    last = &c;
    passed += weight_of(s.weights, c.k, c.j);
    for (; !targets.is_done() && targets.next() < passed; targets.advance())
      points.push_back(canvas.at(c.k, c.j));
  }
  for (; !targets.is_done() && last != nullptr; targets.advance())
    points.push_back(canvas.at(last->k, last->j));
}

}  // namespace troffer
