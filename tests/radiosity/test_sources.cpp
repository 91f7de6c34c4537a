// Contributions per source: direct light is separate, contributions can be recomputed, thin
// occluders count.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "radiosity/rooms.h"
#include "radiosity/source_contributions.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns a room with three sources of different strength and a table top.
Scene three_lamps() {
  Scene s = lit_room(0.5f);
  const uint32_t grey = add_diffuse(s, Rgb{0.3f});
  const auto lamp = [&](const Vec3& at, float size, Rgb radiance) {
    const uint32_t q = add_quad(
        s, grey, {at, at + Vec3{0, size, 0}, at + Vec3{size, size, 0}, at + Vec3{size, 0, 0}});
    make_light(s, q, radiance);
  };
  lamp({0.2f, 0.3f, 2.3f}, 0.4f, {9, 3, 1});
  lamp({3.2f, 2.3f, 2.2f}, 0.3f, {1, 4, 9});
  add_quad(s, grey, {Vec3{1, 1, 1}, {2.5f, 1, 1}, {2.5f, 2, 1}, {1, 2, 1}});
  return s;
}

RadiosityOptions coarse(uint32_t stored) {
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  o.stored_per_point = stored;
  o.unshot_fraction = 0.1f;
  return o;
}

std::vector<uint32_t> all_points(const RadiositySolution& s) {
  std::vector<uint32_t> points(s.mesh.points.size());
  std::iota(points.begin(), points.end(), 0u);
  return points;
}

std::vector<StoredContribution> contributions_of(const Ready& r, const RadiositySolution& s,
                                                 uint32_t source,
                                                 const std::vector<uint32_t>& points) {
  TransferScratch scratch;
  std::vector<StoredContribution> out(points.size());
  source_contributions(r.tracer, r.lights, s, source, points, out, scratch);
  return out;
}

bool is_same(const Rgb& a, const Rgb& b) {
  return std::memcmp(&a, &b, sizeof(Rgb)) == 0;
}

}  // namespace

TEST_CASE("direct light is stored separately") {
  const Ready ready(three_lamps());
  RadiosityOptions only_lights = coarse(4);
  only_lights.unshot_fraction = 1;
  const RadiositySolution direct = ready.solve(only_lights);
  REQUIRE(direct.shots == direct.light_count);
  for (const uint32_t stored : {0u, 2u, 64u}) {
    const RadiositySolution s = ready.solve(coarse(stored));
    uint32_t in_general = 0;
    for (uint32_t i = 0; i < s.mesh.points.size(); ++i) {
      Rgb sum = s.general_direct[i];
      for (const StoredContribution& c : s.contributions(i))
        if (c.source != no_source && s.is_light(c.source)) sum += c.received;
      const Rgb expected = direct.irradiance(i);
      for (size_t k = 0; k < 3; ++k) {
        CHECK(sum[k] == doctest::Approx(expected[k]).epsilon(1e-5));
        CHECK(s.general_direct[i][k] >= 0);
        CHECK(s.general_direct[i][k] <= s.general[i][k] * 1.00001f);
      }
      in_general += !s.general_direct[i].is_black();
    }
    if (stored < 3) CHECK(in_general > s.mesh.points.size() / 4);
    if (stored == 64) CHECK(in_general < s.mesh.points.size() / 4);
  }
}

TEST_CASE("the light of an emitter can be recomputed bit for bit") {
  const Ready ready(three_lamps());
  const RadiositySolution s = ready.solve(coarse(64));
  const std::vector<uint32_t> points = all_points(s);
  for (uint32_t e = 0; e < s.light_count; ++e) {
    const std::vector<StoredContribution> all = contributions_of(ready, s, e, points);
    uint32_t stored = 0;
    for (const uint32_t i : points) {
      CHECK(all[i].source == e);
      for (const StoredContribution& c : s.contributions(i)) {
        if (c.source != e) continue;
        ++stored;
        CHECK(is_same(c.received, all[i].received));
        CHECK(is_same(c.unoccluded, all[i].unoccluded));
      }
    }
    CHECK(stored > points.size() / 4);
    std::vector<uint32_t> some;  // results are equal for a few points
    for (uint32_t i = uint32_t(points.size()); i-- > 0;)
      if (i % 7 == 3) some.push_back(i);
    const std::vector<StoredContribution> part = contributions_of(ready, s, e, some);
    for (size_t k = 0; k < some.size(); ++k) {
      CHECK(is_same(part[k].received, all[some[k]].received));
      CHECK(is_same(part[k].unoccluded, all[some[k]].unoccluded));
    }
  }
}

TEST_CASE("the light of a patch can be recomputed up to noise") {
  const Ready ready(three_lamps());
  RadiosityOptions o = coarse(64);
  o.tolerance = 5e-4f;
  o.max_rays = 256;
  const RadiositySolution s = ready.solve(o);
  const std::vector<uint32_t> points = all_points(s);
  double unoccluded = 0, received = 0;  // sums of squared relative differences
  uint32_t compared = 0;
  for (uint32_t p = 0; p < s.mesh.patches.size(); ++p) {
    const uint32_t source = s.light_count + p;
    const std::vector<StoredContribution> all = contributions_of(ready, s, source, points);
    if (s.shot_radiance[p].is_black()) {
      for (const StoredContribution& c : all) CHECK(c.unoccluded.is_black());
      continue;
    }
    for (const uint32_t i : points) {
      for (const StoredContribution& c : s.contributions(i)) {
        // Strong contributions were never displaced from the list.
        if (c.source != source || luminance(c.unoccluded) < 0.02f * s.mean_irradiance) continue;
        const double u = double(c.unoccluded.g);
        unoccluded += sqr(double(all[i].unoccluded.g) / u - 1);
        received += sqr(double(all[i].received.g - c.received.g) / u);
        ++compared;
      }
    }
  }
  CHECK(compared > 100);
  MESSAGE("rms difference: unoccluded " << std::sqrt(unoccluded / compared) << ", received "
                                        << std::sqrt(received / compared) << " of unoccluded");
  CHECK(std::sqrt(unoccluded / compared) < 0.06);
  CHECK(std::sqrt(received / compared) < 0.06);
}

TEST_CASE("rays to emitters see thin occluders") {
  // A slat of 1/50 of the lamp's width occludes 1/50 of it at the points directly below.
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_quad(s, black, {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const uint32_t lamp = add_quad(s, black, {Vec3{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}});
  make_light(s, lamp, Rgb{1});
  add_quad(s, black,
           {Vec3{-0.03f, -2, 1.9f}, {0.03f, -2, 1.9f}, {0.03f, 2, 1.9f}, {-0.03f, 2, 1.9f}});
  const Ready ready(std::move(s));
  const auto partly_lit = [&](int light_rays) {
    RadiosityOptions o;
    o.meshing = sizes(0.2f, 0.8f);
    o.max_rays = 16;
    o.light_rays = light_rays;
    const RadiositySolution solution = ready.solve(o);
    double count = 0, partly = 0;
    for (uint32_t i = 0; i < solution.mesh.points.size(); ++i) {
      if (solution.mesh.points[i].position.z > 0 || solution.mesh.points[i].normal.z < 0) continue;
      for (const StoredContribution& c : solution.contributions(i)) {
        if (c.source != 0) continue;
        ++count;
        partly += c.received.g < 0.999f * c.unoccluded.g;
      }
    }
    CHECK(count > 100);
    return partly / count;
  };
  CHECK(partly_lit(64) > 0.95);
  CHECK(partly_lit(0) < 0.5);
}
