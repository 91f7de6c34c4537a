#include "shadow/round_cover.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace troffer {

namespace {

constexpr double far_away = 1e9;  // beyond any canvas

// Direction from the receiver to sample (0,0), and the steps between samples.
struct Grid {
  Vec3d first, step_k, step_j;
  int rows;
};

// Half-plane at + j per_j + k per_k >= 0.
struct Linear {
  double at, per_j, per_k;
};

// Region a k² + 2 (b + j b_j) k + c + j c_j + j² c_jj <= 0.
struct Quadratic {
  double a, b, b_j, c, c_j, c_jj;
};

// Samples lower < k <= upper of each row.
struct Spans {
  alignas(64) double lower[most_mask_rows];
  alignas(64) double upper[most_mask_rows];
};

// Returns d · normal >= offset as a condition on samples in direction d.
Linear linear(const Grid& g, const Vec3d& normal, double offset) {
  return {dot(normal, g.first) - offset, dot(normal, g.step_j), dot(normal, g.step_k)};
}

// The symmetric matrix s I + n mᵀ + m nᵀ + t n nᵀ, given by its action.
struct Form {
  double s = 0;
  Vec3d n, m;
  double t = 0;

  double operator()(const Vec3d& a, const Vec3d& b) const {
    const double an = dot(a, n), bn = dot(b, n);
    return s * dot(a, b) + an * dot(b, m) + bn * dot(a, m) + t * an * bn;
  }
};

// Returns d · Form · d <= 0 as a condition on samples.
Quadratic quadratic(const Grid& g, const Form& form) {
  return {form(g.step_k, g.step_k), form(g.first, g.step_k),     form(g.step_j, g.step_k),
          form(g.first, g.first),   2 * form(g.first, g.step_j), form(g.step_j, g.step_j)};
}

// Returns |d - w|² <= radius² as a condition on samples.
Quadratic ball_on_plane(const Grid& g, const Vec3d& w, double radius) {
  const Vec3d first = g.first - w;
  return {dot(g.step_k, g.step_k),  dot(first, g.step_k),
          dot(g.step_j, g.step_k),  dot(first, first) - radius * radius,
          2 * dot(first, g.step_j), dot(g.step_j, g.step_j)};
}

TROFFER_MULTIVERSION
void set_all(double lower, double upper, double* __restrict l, double* __restrict u) {
  for (size_t r = 0; r < most_mask_rows; ++r) {
    l[r] = lower;
    u[r] = upper;
  }
}

TROFFER_MULTIVERSION
void clip(const Linear& line, double* __restrict lower, double* __restrict upper) {
  const double slope = std::abs(line.per_k) < 1e-280 ? 1e-280 : line.per_k;
  const double m = -line.per_j / slope, q = -line.at / slope;
  if (slope > 0)
    for (size_t r = 0; r < most_mask_rows; ++r) {
      const double at = m * double(int(r)) + q;
      lower[r] = lower[r] > at ? lower[r] : at;
    }
  else
    for (size_t r = 0; r < most_mask_rows; ++r) {
      const double at = m * double(int(r)) + q;
      upper[r] = upper[r] < at ? upper[r] : at;
    }
}

// Sets spans to where the quadratic is not positive. If a < 0, the row leaves one half of the cone
// at one root and enters the other half at the other root. is_forwards: larger k lie in the half
// that counts.
TROFFER_MULTIVERSION
void solve(const Quadratic& form, bool is_forwards, double* __restrict lower,
           double* __restrict upper) {
  const double a = std::abs(form.a) < 1e-280 ? 1e-280 : form.a;
  const bool is_between = a > 0;
  for (size_t r = 0; r < most_mask_rows; ++r) {
    const auto j = double(int(r));
    const double b = form.b + j * form.b_j, c = form.c + j * (form.c_j + j * form.c_jj);
    const double square = b * b - a * c, root = std::sqrt(square > 0 ? square : 0);
    const double sum = b > 0 ? -b - root : root - b;  // without cancellation
    const double first = sum / a, second = sum != 0 ? c / sum : 0;
    const double least = first < second ? first : second, most = first < second ? second : first;
    const double none = square > 0 ? 0 : 1;
    const double of_lower =
        is_between ? least + none * 2 * far_away : (is_forwards && square > 0 ? most : -far_away);
    const double of_upper =
        is_between ? most - none * 2 * far_away : (!is_forwards && square > 0 ? least : far_away);
    lower[r] = of_lower;
    upper[r] = of_upper;
  }
}

// Sets the bits of the spans in `out`.
TROFFER_MULTIVERSION
void fill(const double* __restrict lower, const double* __restrict upper, int rows,
          uint32_t* __restrict out) {
  const double limit = rows;
  for (size_t r = 0; r < most_mask_rows; ++r) {
    const double l = lower[r] + 1 < limit ? lower[r] + 1 : limit, u = upper[r] + 1;
    const uint32_t first = uint32_t(int(l > 0 ? l : 0));
    const uint32_t end = uint32_t(int(u < limit ? (u > 0 ? u : 0) : limit));
    out[r] = (~0u << first) & ~(~0u << end);
  }
}

// Returns the samples where the form is not positive and `forwards` is not negative. `forwards`
// selects the half of the cone.
MaskRows covered(const Grid& g, const Quadratic& form, const Linear& forwards) {
  Spans spans;
  solve(form, forwards.per_k > 0, spans.lower, spans.upper);
  clip(forwards, spans.lower, spans.upper);
  MaskRows rows;
  fill(spans.lower, spans.upper, g.rows, rows.row);
  return rows;
}

// Returns the samples hidden by a ball with centre w, relative to the receiver. They lie in the
// cone around it beyond the circle of contact, or inside the ball.
MaskRows hidden_by_ball(const Grid& g, const Vec3d& w, double radius) {
  const double outside = length_squared(w) - radius * radius;
  const Quadratic inside = ball_on_plane(g, w, radius);
  const Linear everywhere{1, 0, 0};
  if (!(outside > 0)) {  // from inside, the ball hides what is outside
    MaskRows rows = covered(g, inside, everywhere);
    for (uint32_t& row : rows.row) row = ~row;
    return rows;
  }
  MaskRows rows = covered(g, quadratic(g, {outside, w, {}, -1}), linear(g, w, outside));
  const Vec3d normal = cross(g.step_k, g.step_j);
  const double height = dot(normal, w - g.first);
  if (height * height < radius * radius * length_squared(normal)) {
    const MaskRows more = covered(g, inside, everywhere);
    for (size_t r = 0; r < most_mask_rows; ++r) rows.row[r] |= more.row[r];
  }
  return rows;
}

// Returns the samples whose rays meet the plane with normal n inside the ball at w. The plane cuts
// a disk from the ball.
MaskRows through_slice(const Grid& g, const Vec3d& n, double height, const Vec3d& w,
                       double radius) {
  const double side = height < 0 ? -1 : 1;
  const Form form{height * height, n, w * -height, length_squared(w) - radius * radius};
  return covered(g, quadratic(g, form), linear(g, n * side, 0));
}

// Sets the samples whose rays meet a sphere before the source, for a sphere that intersects a
// spherical source. Nearly equal distances count as behind, as for facets in the plane of a flat
// source.
TROFFER_MULTIVERSION
void cover_intersecting(const Vec3d& first, const Vec3d& step_k, const Vec3d& step_j, int rows,
                        const Vec3d& source, double source_outside, const Vec3d& ball,
                        double ball_outside, double tolerance, uint32_t* __restrict out) {
  for (size_t r = 0; r < most_mask_rows; ++r) out[r] = 0;
  for (int k = 0; k < rows; ++k) {
    const double x0 = first.x + step_k.x * k, y0 = first.y + step_k.y * k,
                 z0 = first.z + step_k.z * k;
    for (size_t r = 0; r < most_mask_rows; ++r) {
      const auto j = double(int(r));
      const double x = x0 + step_j.x * j, y = y0 + step_j.y * j, z = z0 + step_j.z * j;
      const double square = x * x + y * y + z * z;
      const double to_source = x * source.x + y * source.y + z * source.z;
      const double to_ball = x * ball.x + y * ball.y + z * ball.z;
      const double of_source = to_source * to_source - square * source_outside;
      const double of_ball = to_ball * to_ball - square * ball_outside;
      const double end = to_source - std::sqrt(of_source > 0 ? of_source : 0);
      const double met = to_ball - std::sqrt(of_ball > 0 ? of_ball : 0);
      const double reach = tolerance * std::sqrt(square);
      const uint32_t bit = (of_ball > 0) & (to_ball > 0) & (met < end - reach) ? 1u : 0u;
      out[r] |= bit << k;
    }
  }
}

class Covering {
 public:
  Covering(const MaskFrame& frame, const RoundList& round, const Vec3d& x, const Vec2& shift)
      : round_(round), x_(x) {
    grid_.step_k = frame.step_k();
    grid_.step_j = frame.step_j();
    grid_.first =
        frame.first_sample() - x + grid_.step_k * double(shift.x) + grid_.step_j * double(shift.y);
    grid_.rows = frame.lattice().rows;
    for (size_t a = 0; a < 3; ++a)
      magnitude_ = std::max({magnitude_, std::abs(x[a]), std::abs(x[a] + grid_.first[a])});
  }

  MaskRows hidden_by(const RoundBody& body) const {
    const Vec3d w = Vec3d(body.centre) - x_;
    if (body.is_disk()) return hidden_by_disk(body, w);
    const double radius = body.radius;
    if (!round_.is_source_round) return hidden_by_ball(grid_, w, radius);
    const double apart = length(Vec3d(body.centre) - round_.source.centre);
    if (apart > radius + round_.source.radius) return hidden_by_ball(grid_, w, radius);
    const Vec3d s = round_.source.centre - x_;
    const double outside = length_squared(w) - radius * radius;
    if (!(outside > 0)) return hidden_by_ball(grid_, w, radius);
    MaskRows rows;
    cover_intersecting(grid_.first, grid_.step_k, grid_.step_j, grid_.rows, s,
                       length_squared(s) - round_.source.radius * round_.source.radius, w, outside,
                       round_margin * magnitude_, rows.row);
    return rows;
  }

  // Returns the samples hidden by the part of a facet outside the spherical source.
  MaskRows hidden_by(const Quad& q) const {
    const Vec3d corners[4] = {Vec3d(q[0]) - x_, Vec3d(q[1]) - x_, Vec3d(q[2]) - x_,
                              Vec3d(q[3]) - x_};
    const Vec3d area = cross(corners[2] - corners[0], corners[3] - corners[1]);
    const double size = length(area);
    if (!(size > 0)) return {};
    const Vec3d n = area / size;
    const double height = dot(n, corners[0]), side = height < 0 ? -1 : 1;
    Spans spans;
    set_all(-far_away, far_away, spans.lower, spans.upper);
    // in front of the source: d · n reaches beyond the plane
    clip(linear(grid_, n * side, std::abs(height)), spans.lower, spans.upper);
    for (size_t i = 0; i < 4; ++i) {
      const Vec3d &a = corners[i], &b = corners[(i + 1) % 4];
      // as in coverage masks: (a + b) × (b - a) = 2 a × b
      const Vec3d inwards = cross(a + b, b - a) * side;
      if (length_squared(b - a) > 0) clip(linear(grid_, inwards, 0), spans.lower, spans.upper);
    }
    MaskRows rows;
    fill(spans.lower, spans.upper, grid_.rows, rows.row);
    take_off_source(n, height, rows);
    return rows;
  }

 private:
  MaskRows hidden_by_disk(const RoundBody& body, const Vec3d& w) const {
    const Vec3d n(body.normal);
    const double height = dot(n, w), side = height < 0 ? -1 : 1;
    Spans spans;
    const double radius = body.radius;
    const Form form{height * height, n, w * -height, length_squared(w) - radius * radius};
    const Linear forwards = linear(grid_, n * side, std::abs(height));
    solve(quadratic(grid_, form), forwards.per_k > 0, spans.lower, spans.upper);
    clip(forwards, spans.lower, spans.upper);
    MaskRows rows;
    fill(spans.lower, spans.upper, grid_.rows, rows.row);
    if (round_.is_source_round) take_off_source(n, height, rows);
    return rows;
  }

  void take_off_source(const Vec3d& n, double height, MaskRows& rows) const {
    const MaskRows inside =
        through_slice(grid_, n, height, round_.source.centre - x_, round_.source.radius);
    for (size_t r = 0; r < most_mask_rows; ++r) rows.row[r] &= ~inside.row[r];
  }

  const RoundList& round_;
  Vec3d x_;
  Grid grid_;
  double magnitude_ = 0;
};

}  // namespace

void cover(const MaskFrame& frame, const RoundList& round, const Vec3d& x, const Vec2& shift,
           CoverageMask& mask) {
  if (round.size() == 0 || !mask.is_any_open) return;
  const Covering covering(frame, round, x, shift);
  const auto take_off = [&](const MaskRows& hidden) {
    for (size_t r = 0; r < most_mask_rows; ++r) mask.open.row[r] &= ~hidden.row[r];
  };
  for (const RoundBody& b : round.bodies) take_off(covering.hidden_by(b));
  for (const Quad& q : round.entering) take_off(covering.hidden_by(q));
  mask.is_any_open = std::any_of(mask.open.row, mask.open.row + most_mask_rows,
                                 [](uint32_t row) { return row != 0; });
}

}  // namespace troffer
