#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "brute_force.h"
#include "light/irradiance.h"
#include "shadow/unoccluded.h"

using namespace troffer;
using namespace troffer::test;

namespace {

int count(const MaskRows& rows) {
  int n = 0;
  for (const uint32_t r : rows.row) n += std::popcount(r);
  return n;
}

}  // namespace

TEST_CASE("the square contains a² + b² samples for any shift") {
  const Parallelogram source{{-1, -1, 2}, {2, 0, 0}, {0.3, 2, 0}, {0, 0, -1}};
  Random r(1);
  for (const MaskLattice& lattice : {coarse_lattice, fine_lattice}) {
    for (int i = 0; i < 2000; ++i) {
      const MaskFrame frame(source, lattice, i % 2 == 1, {0, 0, 0});
      CoverageMask mask;
      cover(frame, FacetList(), {0, 0, 0}, r.next_vec2(), mask);
      // rounding may move a sample over the border
      CHECK(std::abs(count(mask.inside) - lattice.samples()) <= 1);
    }
  }
}

TEST_CASE("samples project uniformly on both sides of the source") {
  const Parallelogram source{{0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  const MaskFrame frame(source, coarse_lattice, false, {0, 0, 0});
  const Vec2 shift{0.37f, 0.81f};
  CoverageMask mask;
  cover(frame, FacetList(), {0, 0, 0}, shift, mask);
  const int n = coarse_lattice.samples();
  std::vector<int> across(size_t(n), 0), along(size_t(n), 0);
  for (int j = 0; j < coarse_lattice.rows; ++j)
    for (int k = 0; k < coarse_lattice.rows; ++k) {
      if (((mask.inside.row[j] >> k) & 1u) == 0) continue;
      const Vec3d p = frame.first_sample() + frame.step_k() * (k + double(shift.x)) +
                      frame.step_j() * (j + double(shift.y));
      ++across[size_t(p.x * n)];
      ++along[size_t(p.y * n)];
    }
  for (int i = 0; i < n; ++i) {
    CHECK(across[size_t(i)] == 1);
    CHECK(along[size_t(i)] == 1);
  }
}

TEST_CASE("masks agree with rays, sample by sample, and on all instruction sets") {
  size_t compared = 0, differ = 0, hidden_samples = 0;
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    Random r(seed + 77);
    BruteForceScene scene;
    const FlatSource source = random_source(r);
    add_random_facets(r, scene);
    const ShadowReceiver x = random_receivers(r, 1)[0];
    if (!(dot(source.plane.normal, Vec3d(x.origin) - source.plane.origin) > 1e-3)) continue;
    const MaskLattice lattice = seed % 2 == 0 ? coarse_lattice : fine_lattice;
    const MaskFrame frame(source.plane, lattice, seed % 3 == 0, Vec3d(x.position), source.outline);
    FacetList list;
    if (seed % 4 < 2) {
      for (const Quad& q : scene.facets) list.add(frame, q);
    } else {
      std::vector<FacetToAdd> facets;
      for (const Quad& q : scene.facets) facets.push_back({q, 0, false});
      list.add_many(frame, facets);
    }
    list.finish();
    const Vec2 shift = r.next_vec2();
    CoverageMask mask, plain, middle;
    const Vec3 at = frame.to_canvas(Vec3d(x.origin));
    cover(frame, list, at, shift, mask);
    cover(frame, list, at, shift, plain, 0);
    cover(frame, list, at, shift, middle, 1);
    const MaskWeights w = mask_weights(frame, Vec3d(x.position), x.normal, shift);
    const MaskWeight best = weigh(frame, mask, w), slow = weigh(frame, plain, w, nullptr, 0);
    CHECK(best.open == slow.open);
    CHECK(best.all == slow.all);
    float sum = 0;
    for (int j = 0; j < lattice.rows; ++j) {
      REQUIRE(mask.open.row[j] == plain.open.row[j]);
      REQUIRE(mask.open.row[j] == middle.open.row[j]);
      for (int k = 0; k < lattice.rows; ++k) {
        if (((mask.inside.row[j] >> k) & 1u) == 0) continue;
        const bool is_open = ((mask.open.row[j] >> k) & 1u) != 0;
        if (is_open) sum += weight_of(w, k, j);
        const Vec3d y = frame.first_sample() + frame.step_k() * (k + double(shift.x)) +
                        frame.step_j() * (j + double(shift.y));
        const int hidden = scene.is_hidden(Vec3d(x.origin), y, 3e-6);
        if (hidden < 0) continue;
        ++compared;
        hidden_samples += size_t(hidden);
        differ += (hidden == 0) != is_open;
      }
    }
    CHECK(sum == doctest::Approx(best.open).epsilon(1e-4));
  }
  MESSAGE(compared, " samples, ", hidden_samples, " hidden");
  CHECK(compared > 200000);
  CHECK(hidden_samples > 50000);
  CHECK(differ == 0);
}

TEST_CASE("facets that share edges leave no crack and do not overlap") {
  const Parallelogram source{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1}};
  Random r(5);
  for (int trial = 0; trial < 200; ++trial) {
    const MaskFrame frame(source, fine_lattice, trial % 2 == 1, {0, 0, 0});
    // a wavy sheet of triangles that covers everything
    constexpr int n = 7;
    Vec3 grid[n + 1][n + 1];
    for (auto& row : grid)
      for (Vec3& v : row) {
        const auto i = size_t(&row - grid), j = size_t(&v - row);
        v = {-1.5f + 3 * float(i) / n + 0.1f * r.next_float(),
             -1.5f + 3 * float(j) / n + 0.1f * r.next_float(), 0.8f + 0.3f * r.next_float()};
      }
    FacetList all;
    std::vector<FacetList> single;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (const Quad& q :
             {Quad{grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i + 1][j + 1]},
              Quad{grid[i][j], grid[i + 1][j + 1], grid[i][j + 1], grid[i][j + 1]}}) {
          all.add(frame, q);
          single.emplace_back().add(frame, q);
          single.back().finish();
        }
    all.finish();
    const Vec2 shift = r.next_vec2();
    const Vec3 x = frame.to_canvas({0.1 * r.next_double(), 0.1 * r.next_double(), 0});
    CoverageMask mask;
    cover(frame, all, x, shift, mask);
    CHECK_FALSE(mask.is_any_open);
    int hidden = 0;
    for (const FacetList& one : single) {
      cover(frame, one, x, shift, mask);
      hidden += count(mask.inside) - count(mask.open);
    }
    CHECK(hidden == count(mask.inside));
  }
}

TEST_CASE("small facets that are tested together hide what each hides alone") {
  const Parallelogram source{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1}};
  Random r(9);
  size_t hidden = 0, small = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const MaskLattice lattice = trial % 2 == 0 ? fine_lattice : coarse_lattice;
    const MaskFrame frame(source, lattice, trial % 3 == 1, {0, 0, 0});
    const Vec3 x = frame.to_canvas({0.2 * r.next_double(), 0.2 * r.next_double(), 0});
    // specks, with a few large facets; some beside, just in front of or behind the receiver
    FacetList all;
    std::vector<FacetList> single;
    const float most_size = std::exp(-4 + 3.5f * r.next_float());
    for (int i = 0; i < 500; ++i) {
      const auto coordinate = [&](float size) { return size * (2 * r.next_float() - 1); };
      const float height = trial % 5 == 0 ? -0.3f + 2.2f * r.next_float() : 0.2f + r.next_float();
      const Vec3 centre{coordinate(0.8f), coordinate(0.8f), height};
      const float size = most_size * (i % 97 == 0 ? 10.0f : 1.0f);
      Quad q;
      for (size_t v = 0; v < 3; ++v)
        q[v] = centre + Vec3{coordinate(size), coordinate(size), coordinate(size)};
      q[3] = i % 2 == 0 ? q[2] : q[2] + (q[0] - q[1]);
      all.add(frame, q);
      single.emplace_back().add(frame, q);
      single.back().finish();
    }
    all.finish();
    const Vec2 shift = r.next_vec2();
    CoverageMask together, alone;
    MaskRows open;
    for (const FacetList& one : single) {
      cover(frame, one, x, shift, alone);
      if (&one == single.data()) open = alone.inside;
      for (size_t j = 0; j < most_mask_rows; ++j) open.row[j] &= alone.open.row[j];
      const int of_one = count(alone.inside) - count(alone.open);
      small += of_one > 0 && of_one < 10 ? 1 : 0;
    }
    for (int set = 0; set < 3; ++set) {
      cover(frame, all, x, shift, together, set);
      for (size_t j = 0; j < most_mask_rows; ++j) REQUIRE(together.open.row[j] == open.row[j]);
    }
    hidden += size_t(count(together.inside) - count(together.open));
  }
  CHECK(hidden > 10000);
  CHECK(small > 10000);
}

TEST_CASE("a quadrilateral hides what its two triangles hide") {
  Random r(9);
  for (int trial = 0; trial < 300; ++trial) {
    const FlatSource source = random_source(r);
    const MaskFrame frame(source.plane, coarse_lattice, false, {0, 0, 0}, source.outline);
    const Quad q = parallelogram_facet(random_vector(r, 1) + Vec3{0, 0, 1}, random_vector(r, 1),
                                       random_vector(r, 1));
    FacetList one, two;
    one.add(frame, q);
    two.add(frame, {q[0], q[1], q[2], q[2]});
    two.add(frame, {q[0], q[2], q[3], q[3]});
    one.finish();
    two.finish();
    CoverageMask a, b;
    const Vec2 shift = r.next_vec2();
    cover(frame, one, frame.to_canvas({0, 0, 0}), shift, a);
    cover(frame, two, frame.to_canvas({0, 0, 0}), shift, b);
    int differ = 0;
    for (size_t j = 0; j < most_mask_rows; ++j)
      differ += std::popcount(a.open.row[j] ^ b.open.row[j]);
    CHECK(differ <= 1);  // the diagonal may pass within rounding of a sample on the outline
  }
}

TEST_CASE("only the front of a facet occludes if requested") {
  const Parallelogram source{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1}};
  const Quad up{Vec3{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}};    // front above
  const Quad down{Vec3{-9, -9, 1}, {-9, 9, 1}, {9, 9, 1}, {9, -9, 1}};  // front below
  for (const bool is_mirrored : {false, true}) {
    for (const double flip : {1.0, -1.0}) {
      Parallelogram p = source;
      if (flip < 0) {  // sides in the other order: the canvas has the other handedness
        std::swap(p.u, p.v);
      }
      const MaskFrame frame(p, coarse_lattice, is_mirrored, {0, 0, 0});
      CoverageMask mask;
      FacetList a, b;
      a.add(frame, up, true);
      b.add(frame, down, true);
      a.finish();
      b.finish();
      cover(frame, a, frame.to_canvas({0, 0, 0}), {0.5f, 0.5f}, mask);
      CHECK(count(mask.open) == coarse_lattice.samples());
      cover(frame, b, frame.to_canvas({0, 0, 0}), {0.5f, 0.5f}, mask);
      CHECK(count(mask.open) == 0);
    }
  }
}

TEST_CASE("irradiance of many receivers equals that of single ones") {
  Random r(11);
  for (int trial = 0; trial < 300; ++trial) {
    const FlatSource source = random_source(r);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 21);
    ReceiverArrays arrays;
    arrays.assign(receivers.size());
    for (size_t i = 0; i < receivers.size(); ++i)
      arrays.set(i, receivers[i].position, receivers[i].normal);
    std::vector<float> out(receivers.size());
    const std::vector<Vec3d> corners = source.corners();
    unoccluded_irradiance(corners, source.plane.normal, arrays, out.data());
    for (size_t i = 0; i < out.size(); ++i) {
      const Vec3d x(receivers[i].position);
      const double expected =
          dot(source.plane.normal, x - source.plane.origin) > 0
              ? polygon_irradiance(corners, x, Vec3d(receivers[i].normal), Sides::both)
              : 0;
      CHECK(double(out[i]) == doctest::Approx(expected).epsilon(2e-5));
    }
  }
}
