// Compares masks and certificates of spheres, disks and facets that enter a round source with rays
// to each sample, in double precision and by other formulas.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "shadow/round_certificate.h"
#include "shadow/round_cover.h"
#include "shadow/sphere_outline.h"

using namespace troffer;

namespace test_round_cover {

namespace {

Vec3d in_cube(Random& r) {
  return {2 * r.next_double() - 1, 2 * r.next_double() - 1, 2 * r.next_double() - 1};
}

// Returns a signed margin: positive if the segment meets the body, near 0 if the answer is in
// doubt.
double meets(const RoundBody& body, const Vec3d& x, const Vec3d& y) {
  const Vec3d c(body.centre), d = y - x;
  const double radius = body.radius;
  if (body.is_disk()) {
    const Vec3d n(body.normal);
    const double from = dot(n, x - c), to = dot(n, y - c);
    if ((from > 0) == (to > 0)) return -std::min(std::abs(from), std::abs(to));
    const double off = radius - length(x + d * (from / (from - to)) - c);
    return std::min({off, std::abs(from), std::abs(to)});
  }
  // nearest point of the segment, unless both ends are inside
  const double t = std::clamp(dot(c - x, d) / length_squared(d), 0.0, 1.0);
  const double inside = radius - length(x + d * t - c);
  const double ends = std::max(length(x - c), length(y - c)) - radius;
  return std::min(inside, ends);
}

double meets(const Quad& q, const Vec3d& x, const Vec3d& y) {
  const Vec3d a(q[0]), n = normalize(cross(Vec3d(q[2]) - a, Vec3d(q[3]) - Vec3d(q[1])));
  const double from = dot(n, x - a), to = dot(n, y - a);
  if ((from > 0) == (to > 0)) return -std::min(std::abs(from), std::abs(to));
  const Vec3d p = x + (y - x) * (from / (from - to));
  double inside = std::min(std::abs(from), std::abs(to));
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d v(q[i]), w(q[(i + 1) % 4]);
    if (length(w - v) > 0) inside = std::min(inside, dot(cross(w - v, p - v), n) / length(w - v));
  }
  return inside;
}

// Returns the point where the segment from x first meets the sphere.
Vec3d near_end(const SphereSource& s, const Vec3d& x, const Vec3d& through) {
  const Vec3d d = normalize(through - x), c = s.centre - x;
  const double along = dot(c, d), square = s.radius * s.radius - length_squared(c - d * along);
  return x + d * (along - std::sqrt(std::max(square, 0.0)));
}

RoundBody random_body(Random& r, const Vec3d& about, double reach) {
  RoundBody b;
  b.centre = Vec3(about + in_cube(r) * reach);
  b.radius = float(0.02 * std::pow(60.0, r.next_double()));
  if (r.next_double() < 0.5) b.normal = Vec3(normalize(in_cube(r)));
  return b;
}

Parallelogram random_source(Random& r) {
  Parallelogram p{{-0.5, -0.4, 2}, {1, 0.2 * r.next_double(), 0}, {0, 0.8, 0}, {}};
  p.normal = normalize(cross(p.v, p.u));
  return p;
}

struct Tally {
  size_t samples = 0, hidden = 0, wrong = 0;

  template <class Hidden>
  void compare(const MaskFrame& frame, const Vec2& shift, const CoverageMask& mask,
               const Hidden& margin) {
    for (int j = 0; j < frame.lattice().rows; ++j)
      for (int k = 0; k < frame.lattice().rows; ++k) {
        if ((mask.inside.row[j] >> k & 1u) == 0) continue;
        const double by = margin(frame.first_sample() + frame.step_k() * (k + double(shift.x)) +
                                 frame.step_j() * (j + double(shift.y)));
        if (std::abs(by) < 1e-9) continue;
        ++samples;
        const bool is_hidden = (mask.open.row[j] >> k & 1u) == 0;
        hidden += is_hidden;
        wrong += is_hidden != (by > 0);
      }
  }
};

CoverageMask covered(const MaskFrame& frame, const RoundList& round, const Vec3d& x,
                     const Vec2& shift) {
  CoverageMask mask;
  cover(frame, FacetList(), frame.to_canvas(x), shift, mask);
  cover(frame, round, x, shift, mask);
  return mask;
}

}  // namespace

TEST_CASE("spheres and disks in front of flat sources: each sample agrees with its ray") {
  Random r(1);
  Tally tally;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d x = Vec3d{2 * in_cube(r).x, 2 * in_cube(r).y, 1 + 0.9 * in_cube(r).z};
    const MaskFrame frame(random_source(r), i % 2 == 0 ? coarse_lattice : fine_lattice, i % 3 == 0,
                          {0, 0, 1}, {}, i % 5 == 0);
    RoundList round;
    // between the two, through the source's plane, or around the receiver
    const Vec3d about = i % 4 == 0 ? Vec3d{0, 0, 2} : i % 4 == 1 ? x : (x + Vec3d{0, 0, 2}) * 0.5;
    round.bodies.push_back(random_body(r, about, 0.6));
    const RoundBody& body = round.bodies[0];
    if (!body.is_disk() && length(x - Vec3d(body.centre)) < 1.001 * double(body.radius)) continue;
    const Vec2 shift = r.next_vec2();
    tally.compare(frame, shift, covered(frame, round, x, shift),
                  [&](const Vec3d& y) { return meets(body, x, y); });
  }
  MESSAGE(tally.hidden, " hidden of ", tally.samples, ", wrong ", tally.wrong);
  CHECK(tally.hidden > 100'000);
  CHECK(tally.hidden < tally.samples / 2);
  CHECK(tally.wrong == 0);
}

TEST_CASE("a body that enters a round source hides with its part outside") {
  Random r(2);
  Tally tally;
  for (int i = 0; i < 4000; ++i) {
    const SphereSource source{{0, 0, 2}, 0.2 + 0.3 * r.next_double(), 0};
    const Vec3d x =
        source.centre + normalize(in_cube(r)) * (source.radius * (1.1 + r.next_double() * 4));
    const MaskFrame frame(outline_of(source, x), i % 2 == 0 ? coarse_lattice : fine_lattice,
                          i % 3 == 0, {0, 0, 1}, {}, true);
    RoundList round;
    round.is_source_round = true;
    round.source = {source.centre, source.radius};
    const Vec3d p = source.centre + in_cube(r) * source.radius;
    if (i % 2 == 0) {
      round.bodies.push_back(random_body(r, source.centre, source.radius));
      if (i % 4 == 0) round.bodies[0].normal = {};
      if (!round.bodies[0].is_disk() &&
          length(x - Vec3d(round.bodies[0].centre)) < 1.001 * double(round.bodies[0].radius))
        continue;
    } else {
      const Vec3d u = in_cube(r), v = cross(u, in_cube(r)) * (0.3 + r.next_double());
      const double s = 0.1 + r.next_double();
      round.entering.push_back({Vec3(p - u * s), Vec3(p + v * s), Vec3(p + u * s),
                                i % 3 == 0 ? Vec3(p + u * s) : Vec3(p - v * s)});
    }
    const Vec2 shift = r.next_vec2();
    const CoverageMask mask = covered(frame, round, x, shift);
    tally.compare(frame, shift, mask, [&](const Vec3d& y) {
      const Vec3d end = near_end(source, x, y);
      if (!round.entering.empty()) {
        // in single precision the corners of a quadrilateral are not quite coplanar
        const double by = meets(round.entering[0], x, end);
        return std::abs(by) < 1e-6 ? 0 : by;
      }
      const double by = meets(round.bodies[0], x, end);
      return std::abs(by) < 1e-5 ? 0 : by;  // contact at the source counts as behind
    });
  }
  MESSAGE(tally.hidden, " hidden of ", tally.samples, ", wrong ", tally.wrong);
  CHECK(tally.hidden > 80'000);
  CHECK(tally.wrong == 0);
}

TEST_CASE("certificates of spheres and disks are not contradicted by any segment") {
  Random r(3);
  size_t nothing = 0, all = 0, wrong = 0;
  for (int i = 0; i < 40'000; ++i) {
    const double scale = i % 3 == 0 ? 1 : i % 3 == 1 ? 40 : 1e-3;
    const double offsets[] = {0, 1000, 5000};
    const Vec3d offset{offsets[i % 9 / 3], -offsets[i % 9 / 3] * 0.7, 0};
    const auto place = [&](const Vec3d& p) { return p * scale + offset; };
    Parallelogram source = random_source(r);
    source.u = source.u * (scale * (0.1 + r.next_double()));
    source.v = source.v * scale;
    source.origin = place(source.origin);
    const MaskFrame frame(source, coarse_lattice, false, place({0, 0, 1}));
    std::vector<Vec3> at, normals;
    const Vec3d middle = in_cube(r);
    const double width = 0.5 * r.next_double();
    for (int k = 0; k < 16; ++k) {
      const Vec3d p = middle + in_cube(r) * width;
      at.push_back(Vec3(place({p.x, p.y, i % 2 == 0 ? 0.0 : 0.3 * p.z})));
      normals.push_back({0, 0, 1});
    }
    const ReceiverHull hull = bound_receivers(at, normals);
    RoundBody body = random_body(r, {middle.x * 0.5, middle.y * 0.5, 1}, 0.6);
    body.radius *= float((1 + 2 * r.next_double()) * scale);
    body.centre = Vec3(place(Vec3d(body.centre)));
    const RoundFlag flag = classify(body, frame, hull);
    nothing += flag == RoundFlag::hides_nothing;
    all += flag == RoundFlag::hides_all;
    if (flag == RoundFlag::unknown) continue;
    for (int k = 0; k < 32; ++k) {
      const Vec3d x(at[size_t(k) % at.size()]);
      const double u = r.next_double(), v = r.next_double();
      const bool is_corner = k % 2 == 0;
      const Vec3d y = source.origin + source.u * (is_corner ? std::round(u) : u) +
                      source.v * (is_corner ? std::round(v) : v);
      const double by = meets(body, x, y);
      wrong += flag == RoundFlag::hides_all ? by <= 0 : by > 0;
    }
  }
  MESSAGE(nothing, " hide nothing, ", all, " hide all, wrong ", wrong);
  CHECK(nothing > 6000);
  CHECK(all > 800);
  CHECK(wrong == 0);
}

}  // namespace test_round_cover
