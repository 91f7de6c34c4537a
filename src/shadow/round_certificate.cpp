#include "shadow/round_certificate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shadow/round_cover.h"

namespace troffer {

namespace {

// Corners of receivers and cell relative to the body's centre. The cell may be far away.
struct Corners {
  std::array<Vec3d, 8 + most_source_corners> at;
  size_t receivers = 0, count = 0;
  // Possible displacement of receivers, and of the cell's corners.
  double slack = 0, cell_slack = 0;

  Corners(const RoundBody& body, const MaskFrame& frame, const ReceiverHull& hull) {
    const Vec3d centre(body.centre);
    const auto largest = [](const Vec3d& p) {
      return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    };
    double magnitude = largest(centre) + double(body.radius);
    const auto add = [&](const Vec3d& p) {
      magnitude = std::max(magnitude, largest(p));
      at[count++] = p - centre;
    };
    for (int i = 0; i < hull.count; ++i) add(hull.corners[size_t(i)]);
    receivers = count;
    slack = hull.slack + round_margin * magnitude;
    for (int i = 0; i < frame.corner_count(); ++i) {
      const MaskFrame::Corner& c = frame.corners()[i];
      add(frame.first_sample() + frame.step_k() * double(c.k) + frame.step_j() * double(c.j));
    }
    cell_slack = round_margin * magnitude;
  }
  std::span<const Vec3d> of_receivers() const { return {at.data(), receivers}; }
  std::span<const Vec3d> of_cell() const { return {at.data() + receivers, count - receivers}; }
};

// Returns the extent of the body along a unit vector.
double reach(const RoundBody& body, const Vec3d& n) {
  const double radius = body.radius;
  if (!body.is_disk()) return radius;
  return radius *
         std::sqrt(std::max(1 - dot(n, Vec3d(body.normal)) * dot(n, Vec3d(body.normal)), 0.0));
}

// True if a plane with unit normal n separates the body from all corners, and so from every
// segment.
bool parts(const RoundBody& body, const Corners& c, const Vec3d& n) {
  const double least = reach(body, n);
  for (size_t i = 0; i < c.count; ++i)
    if (!(dot(n, c.at[i]) > least + (i < c.receivers ? c.slack : c.cell_slack))) return false;
  return true;
}

// Looks for a separating plane, across the direction to the nearest point of the convex hull. Steps
// towards corners approach that point. Any separating plane is a proof.
bool hides_nothing(const RoundBody& body, const Corners& c) {
  if (body.is_disk())
    for (const double sign : {1.0, -1.0})
      if (parts(body, c, Vec3d(body.normal) * sign)) return true;
  constexpr int most_steps = 8;
  Vec3d p = c.at[0];
  for (size_t i = 1; i < c.count; ++i)
    if (length_squared(c.at[i]) < length_squared(p)) p = c.at[i];
  for (int step = 0; step < most_steps; ++step) {
    const double distance = length(p);
    if (!(distance > 0)) return false;
    if (parts(body, c, p / distance)) return true;
    Vec3d corner = c.at[0];
    for (size_t i = 1; i < c.count; ++i)
      if (dot(p, c.at[i]) < dot(p, corner)) corner = c.at[i];
    const Vec3d way = corner - p;
    const double square = length_squared(way);
    if (!(square > 0)) return false;
    p = p + way * std::clamp(-dot(p, way) / square, 0.0, 1.0);
  }
  return false;
}

// True if the segment passes through the body even if its ends are displaced as far as possible.
bool passes_through(const RoundBody& body, const Vec3d& x, const Vec3d& y, const Corners& c) {
  const Vec3d d = y - x;
  const double radius = body.radius;
  if (!body.is_disk()) {
    const double square = length_squared(d);
    const double t = square > 0 ? std::clamp(-dot(x, d) / square, 0.0, 1.0) : 0;
    return length(x + d * t) < radius - (1 - t) * c.slack - t * c.cell_slack;
  }
  const Vec3d n(body.normal);
  const double from = dot(n, x), to = dot(n, y), across = std::abs(from - to);
  if (!(std::abs(from) > c.slack) || !(std::abs(to) > c.cell_slack)) return false;
  if ((from > 0) == (to > 0)) return false;
  const double t = from / (from - to), slack = (1 - t) * c.slack + t * c.cell_slack;
  const Vec3d p = x + d * t;
  return length(p) < radius - 2 * slack * (1 + length(d) / across);
}

// True if the body hides the whole cell from all receivers. The receivers from which a convex body
// hides a point form a convex set, and so do the points that it hides from a receiver. Corners
// therefore suffice. A sphere must lie in front of the whole cell.
bool hides_all(const RoundBody& body, const Corners& c) {
  if (!body.is_disk()) {
    Vec3d normal;
    const std::span<const Vec3d> cell = c.of_cell();
    for (size_t i = 1; i + 1 < cell.size(); ++i)
      normal += cross(cell[i] - cell[0], cell[i + 1] - cell[0]);
    const double size = length(normal);
    if (!(size > 0)) return false;
    const double height = dot(normal, cell[0]) / size;
    if (!(std::abs(height) > double(body.radius) + c.cell_slack)) return false;
    for (const Vec3d& x : c.of_receivers())
      if (!(length(x) > double(body.radius) + c.slack)) return false;
  }
  for (const Vec3d& x : c.of_receivers())
    for (const Vec3d& y : c.of_cell())
      if (!passes_through(body, x, y, c)) return false;
  return true;
}

}  // namespace

RoundFlag classify(const RoundBody& body, const MaskFrame& frame, const ReceiverHull& hull) {
  const Corners corners(body, frame, hull);
  if (hides_nothing(body, corners)) return RoundFlag::hides_nothing;
  return hides_all(body, corners) ? RoundFlag::hides_all : RoundFlag::unknown;
}

}  // namespace troffer
