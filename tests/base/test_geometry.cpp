// Vectors, boxes, frames, transforms, colour.
#include <doctest/doctest.h>

#include "base/box.h"
#include "base/frame.h"
#include "base/random.h"
#include "base/rgb.h"
#include "base/transform.h"
#include "base/units.h"
#include "base/warp.h"

using namespace troffer;

namespace {

Vec3d random_vector(Random& r) {
  return {2 * r.next_double() - 1, 2 * r.next_double() - 1, 2 * r.next_double() - 1};
}
Affine random_affine(Random& r) {
  Affine a;
  do {
    for (Vec3d& c : a.columns) c = random_vector(r) * 3;
  } while (std::abs(a.determinant()) < 0.1);
  a.translation = random_vector(r) * 10;
  return a;
}

}  // namespace

TEST_CASE("frames about any normal are orthonormal and right-handed") {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    Vec3 n = sphere_from_square(random.next_vec2());
    if (i == 0) n = {0, 0, 1};
    if (i == 1) n = {0, 0, -1};
    if (i == 2) n = normalize(Vec3{1e-5f, -1e-5f, -1});
    const Frame f(n);
    const bool is_good = std::abs(length(f.tangent) - 1) < 2e-6f &&
                         std::abs(length(f.bitangent) - 1) < 2e-6f &&
                         std::abs(dot(f.tangent, f.bitangent)) < 2e-6f &&
                         std::abs(dot(f.tangent, f.normal)) < 2e-6f &&
                         std::abs(dot(f.bitangent, f.normal)) < 2e-6f &&
                         dot(cross(f.tangent, f.bitangent), f.normal) > 0.99f;
    const Vec3 w = sphere_from_square(random.next_vec2());
    CHECK(is_good);
    CHECK(length(f.to_world(f.to_local(w)) - w) < 2e-6f);
    CHECK(std::abs(f.to_local(w).z - dot(w, n)) < 1e-6f);
  }
}

TEST_CASE("transforms: inverse, product, normals") {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Affine a = random_affine(random), b = random_affine(random), back = inverse(a);
    const Vec3d p = random_vector(random), q = random_vector(random);
    CHECK(length(back.point(a.point(p)) - p) < 1e-9);
    CHECK(length((a * b).point(p) - a.point(b.point(p))) < 1e-9);
    CHECK(length((a * b).vector(p) - a.vector(b.vector(p))) < 1e-9);
    CHECK((a * b).determinant() ==
          doctest::Approx(a.determinant() * b.determinant()).epsilon(1e-9));
    // normal of a transformed plane, with its sign
    CHECK(length(a.normal(cross(p, q)) - cross(a.vector(p), a.vector(q))) < 1e-9);
  }
  const Affine turn = Affine::rotate(rad_from_deg(90), {0, 0, 2});
  CHECK(length(turn.point({1, 0, 0}) - Vec3d{0, 1, 0}) < 1e-12);
  CHECK_FALSE(turn.swaps_handedness());
  CHECK(Affine::scale({1, -2, 1}).swaps_handedness());
  CHECK(Affine::scale({1, -2, 1}).determinant() == -2);
  CHECK(Affine::translate({1, 2, 3}).point({1, 1, 1}) == Vec3d{2, 3, 4});
  CHECK(Affine::translate({1, 2, 3}).vector({1, 1, 1}) == Vec3d{1, 1, 1});
  // a flattening transform still has a normal
  CHECK(Affine::scale({1, 1, 0}).normal({0, 0, 1}) == Vec3d{0, 0, 1});
}

TEST_CASE("boxes grow from nothing") {
  Box b;
  CHECK(b.is_empty());
  CHECK(b.diagonal() == 0);
  b.grow(Vec3{1, 2, 3});
  CHECK_FALSE(b.is_empty());
  CHECK(b.diagonal() == 0);
  Box c;
  c.grow(Vec3{-1, 5, 3});
  b.grow(c);
  b.grow(Box{});  // empty box
  CHECK(b.lower == Vec3{-1, 2, 3});
  CHECK(b.upper == Vec3{1, 5, 3});
  CHECK(b.centre() == Vec3{0, 3.5f, 3});
  CHECK(b.diagonal() == doctest::Approx(std::sqrt(13.0)));
}

TEST_CASE("vectors and colours") {
  const Vec3 a{1, 2, 3}, b{-2, 0.5f, 4};
  CHECK(dot(cross(a, b), a) == 0);
  CHECK(dot(cross(a, b), b) == 0);
  CHECK(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}) == Vec3{0, 0, 1});
  CHECK(length(normalize(b)) == doctest::Approx(1));
  CHECK(min(a, b) == Vec3{-2, 0.5f, 3});
  CHECK_FALSE(is_finite(Vec3{1, std::nanf(""), 0}));
  CHECK(luminance(Rgb{1}) == doctest::Approx(1));
  CHECK(clamp01({-1, 0.5f, 3}) == Rgb{0, 0.5f, 1});
  for (int i = 0; i <= 1000; ++i) {
    const float v = float(i) / 1000;
    CHECK(std::abs(srgb_from_linear(linear_from_srgb(v)) - v) < 1e-5f);
  }
  CHECK(linear_from_srgb(0.5f) == doctest::Approx(0.21404).epsilon(1e-4));  // IEC 61966-2-1
}
