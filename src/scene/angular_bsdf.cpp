#include "scene/angular_bsdf.h"

#include <algorithm>
#include <cmath>

#include "base/hasher.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr uint64_t angular_hash = 0x4b6c656d73;  // start of hashes, different from other keys

// Azimuth of (x, y) in turns, in [0, 1).
double turn_of(const Vec3& w) {
  const double turn = std::atan2(double(w.y), double(w.x)) / (2 * pi);
  return turn < 0 ? turn + 1 : turn;
}

void add(Hasher& h, const AngleMatrix& m) {
  for (const AngleBasis* basis : {&m.in, &m.out}) {
    h.add(basis->rings());
    for (const AngleBasis::Ring& r : basis->all_rings()) h.add_all(r.theta_deg, r.patches);
  }
  h.add(m.values.size());
  for (const float v : m.values) h.add(v);
}

}  // namespace

AngleBasis::AngleBasis(std::vector<Ring> rings) : rings_(std::move(rings)), first_{0} {
  for (size_t r = 0; r <= rings_.size(); ++r) {
    const double theta = r < rings_.size() ? rad_from_deg(rings_[r].theta_deg) : pi / 2;
    sine2_.push_back(r < rings_.size() ? std::sin(theta) * std::sin(theta) : 1.0);
    cosine_.push_back(r < rings_.size() ? float(std::cos(theta)) : 0.0f);
    if (r < rings_.size()) first_.push_back(first_.back() + size_t(rings_[r].patches));
  }
}

size_t AngleBasis::patch_of(const Vec3& w) const {
  const float cosine = std::abs(w.z);
  size_t ring = 0;
  while (ring + 1 < rings_.size() && cosine <= cosine_[ring + 1]) ++ring;
  const auto n = size_t(rings_[ring].patches);
  if (n == 1) return first_[ring];
  const auto k = size_t(turn_of(w) * double(n) + 0.5);
  return first_[ring] + (k < n ? k : 0);
}

size_t AngleBasis::ring_of(size_t patch) const {
  const auto after = std::upper_bound(first_.begin(), first_.end(), patch);
  return size_t(after - first_.begin()) - 1;
}

Vec3 AngleBasis::direction(size_t patch, const Vec2& u) const {
  const size_t ring = ring_of(patch);
  const double sine2 = sine2_[ring] + (sine2_[ring + 1] - sine2_[ring]) * double(u.x);
  const double sine = std::sqrt(sine2);
  const double azimuth =
      2 * pi * (double(patch - first_[ring]) + double(u.y) - 0.5) / double(rings_[ring].patches);
  return {float(std::cos(azimuth) * sine), float(std::sin(azimuth) * sine),
          float(std::sqrt(std::max(0.0, 1 - sine2)))};
}

double AngleBasis::projected_solid_angle(size_t patch) const {
  const size_t ring = ring_of(patch);
  return pi * (sine2_[ring + 1] - sine2_[ring]) / double(rings_[ring].patches);
}

std::vector<size_t> AngleBasis::neighbours(size_t patch) const {
  const size_t ring = ring_of(patch), k = patch - first_[ring];
  const auto n = size_t(rings_[ring].patches);
  std::vector<size_t> out;
  if (n > 1) out.push_back(first_[ring] + (k + 1) % n);
  if (n > 2) out.push_back(first_[ring] + (k + n - 1) % n);
  // Bounds in azimuth of patch i of m, in turns: (i ± 1/2) / m.
  const auto touch = [&](size_t other) {
    const auto m = size_t(rings_[other].patches);
    for (size_t i = 0; i < m; ++i) {
      double apart = std::abs(double(i) / double(m) - double(k) / double(n));
      apart = std::min(apart, 1 - apart);
      if (apart < 0.5 / double(m) + 0.5 / double(n) - 1e-9) out.push_back(first_[other] + i);
    }
  };
  if (ring > 0) touch(ring - 1);
  if (ring + 1 < rings_.size()) touch(ring + 1);
  return out;
}

bool AngleBasis::operator==(const AngleBasis& other) const {
  return std::equal(rings_.begin(), rings_.end(), other.rings_.begin(), other.rings_.end(),
                    [](const Ring& a, const Ring& b) {
                      return a.patches == b.patches && std::abs(a.theta_deg - b.theta_deg) < 1e-6;
                    });
}

AngleBasis klems_full() {
  return AngleBasis(
      {{0, 1}, {5, 8}, {15, 16}, {25, 20}, {35, 24}, {45, 24}, {55, 24}, {65, 16}, {75, 12}});
}

AngleBasis klems_half() {
  return AngleBasis({{0, 1}, {6.5, 8}, {19.5, 12}, {32.5, 16}, {46.5, 20}, {61.5, 12}, {76.5, 4}});
}

AngleBasis klems_quarter() {
  return AngleBasis({{0, 1}, {9, 8}, {27, 12}, {46, 12}, {66, 8}});
}

double AngleMatrix::hemispherical(size_t i) const {
  double sum = 0;
  for (size_t o = 0; o < out.size(); ++o) sum += double(at(o, i)) * out.projected_solid_angle(o);
  return sum;
}

namespace {

// Patch of `to` that holds the direction opposite to the middle of a patch of `from`: incident and
// leaving directions have opposite signs of x and y.
size_t opposite(const AngleBasis& from, size_t patch, const AngleBasis& to) {
  const Vec3 w = from.direction(patch, {0.5f, 0.5f});
  return to.patch_of({-w.x, -w.y, w.z});
}

}  // namespace

AngleMatrix reversed(const AngleMatrix& m) {
  AngleMatrix r;
  if (m.is_empty()) return r;
  r.in = m.out;
  r.out = m.in;
  r.values.resize(m.values.size());
  for (size_t o = 0; o < r.out.size(); ++o) {
    const size_t i_there = opposite(r.out, o, m.in);
    for (size_t i = 0; i < r.in.size(); ++i)
      r.values[o * r.in.size() + i] = m.at(opposite(r.in, i, m.out), i_there);
  }
  return r;
}

double reciprocity_error(const AngleMatrix& m, const AngleMatrix& reverse) {
  const AngleMatrix wanted = reversed(reverse);
  float largest = 0, difference = 0;
  for (size_t k = 0; k < m.values.size() && k < wanted.values.size(); ++k) {
    largest = std::max({largest, m.values[k], wanted.values[k]});
    difference = std::max(difference, std::abs(m.values[k] - wanted.values[k]));
  }
  return largest > 0 ? double(difference / largest) : 0;
}

uint64_t hash_of(const AngularBsdf& b) {
  Hasher h(angular_hash);
  for (const AngleMatrix* m : {&b.to_front, &b.to_back, &b.front_reflection, &b.back_reflection})
    add(h, *m);
  return h.value();
}

}  // namespace troffer
