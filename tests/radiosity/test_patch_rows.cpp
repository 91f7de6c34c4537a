// Rows of form factors: compared with transfers of many rays, repeated, and bounded in memory.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "base/units.h"
#include "radiosity/patch_rows.h"
#include "radiosity/rooms.h"
#include "radiosity/shooter_cells.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Scene room_with_block() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  make_light(s, add_box_inside(s, grey, {0, 0, 0}, {3, 2, 2.5f})[1], Rgb{1});
  for (const uint32_t q : add_box_inside(s, grey, {1, 0.7f, 0.4f}, {1.8f, 1.2f, 1.3f}))
    std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);
  return s;
}

struct Rows {
  Ready ready;
  RadiosityMesh mesh;
  PatchRows rows;
  ShotReceived out;
  std::vector<float> seen;
  explicit Rows(size_t most_bytes)
      : ready(room_with_block()),
        mesh(ready.mesh(sizes(0.3f, 0.9f))),
        rows(mesh, ready.tracer, 2, most_bytes) {
    out.unoccluded.resize(rows.receivers().slots());
    out.received.resize(rows.receivers().slots());
    seen.resize(rows.receivers().slots());
  }

  const ReceiverBlock& block(uint32_t b) const { return rows.receivers().blocks[b]; }

  // Returns, per point, the irradiance per unit of mean radiance from a patch with the given
  // shares.
  std::vector<float> shoot(uint32_t patch, const std::vector<float>& shares = {}) {
    Shooter shooter = patch_shooter(mesh, patch, Rgb{1});
    if (!shares.empty()) set_parts(shooter, mesh, patch, shares);
    RayBudget budget;
    budget.reference = pi_f;
    const StopFlag never = false;
    REQUIRE(rows.shoot(patch, shooter, 1, budget, 5, never, true, {}, seen, out));
    std::vector<float> received(mesh.points.size(), 0.0f);
    for (const uint32_t b : out.blocks)
      for (uint32_t i = 0; i < block(b).count; ++i) {
        const uint32_t slot = block(b).first_slot + i;
        received[block(b).first_point + i] = out.received[slot];
        CHECK(out.received[slot] <= out.unoccluded[slot] * 1.0001f);
      }
    return received;
  }

  double power(const std::vector<float>& received) const {
    double sum = 0;
    for (size_t i = 0; i < received.size(); ++i)
      sum += double(received[i]) * double(mesh.points[i].area);
    return sum;
  }
};

}  // namespace

TEST_CASE("form factors of rows agree with many rays") {
  Rows r(1u << 30);
  RayBudget many;
  many.max_rays = 512;
  many.tolerance = 1e-5f;
  many.reference = pi_f;
  TransferScratch scratch;
  std::vector<Transfer> exact(r.mesh.points.size());
  std::vector<double> sums(exact.size());
  double squares = 0, count = 0, sum = 0, exact_sum = 0;
  for (uint32_t patch = 0; patch < r.mesh.patches.size(); ++patch) {
    const std::vector<float> received = r.shoot(patch);
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += double(received[i]) / pi;
    if (patch % 5 != 0) continue;
    transfer(patch_shooter(r.mesh, patch, Rgb{1}), r.mesh.points, r.ready.tracer, many, 1, 0, exact,
             scratch);
    for (size_t i = 0; i < exact.size(); ++i) {
      const double wanted = double(exact[i].unoccluded.g * exact[i].visibility) / pi;
      squares += sqr(double(received[i]) / pi - wanted);
      sum += double(received[i]) / pi;
      exact_sum += wanted;
      ++count;
    }
  }
  MESSAGE("form factors: rms error " << std::sqrt(squares / count) << ", mean " << sum / exact_sum);
  CHECK(std::sqrt(squares / count) < 0.0015);
  CHECK(sum == doctest::Approx(exact_sum).epsilon(0.005));
  double worst = 0, mean = 0;
  for (const double row : sums) {
    worst = std::max(worst, std::abs(row - 1));
    mean += row / double(sums.size());
  }
  MESSAGE("row sums: mean " << mean << ", largest error " << worst);
  CHECK(mean == doctest::Approx(1).epsilon(0.005));
  CHECK(worst < 0.06);
  for (const ReceiverBlock& b : r.rows.receivers().blocks)
    for (uint32_t i = 0; i < b.count; ++i)
      CHECK(double(r.seen[b.first_slot + i]) ==
            doctest::Approx(sums[b.first_point + i]).epsilon(0.02));
}

TEST_CASE("later shots reuse stored rows; rows that are not stored are recomputed identically") {
  Rows kept(1u << 30), not_kept(0);
  const uint32_t patch = uint32_t(kept.mesh.patches.size() / 2);
  const std::vector<float> first = kept.shoot(patch), found = not_kept.shoot(patch);
  const uint64_t rays = kept.rows.rays();
  CHECK(rays > 0);
  CHECK(kept.rows.bytes() > 0);
  CHECK(kept.shoot(patch) == first);
  CHECK(kept.rows.rays() == rays);
  CHECK(kept.rows.rows_not_kept() == 0);
  CHECK(found == first);
  CHECK(not_kept.shoot(patch) == first);
  CHECK(not_kept.rows.rays() == 2 * rays);
  CHECK(not_kept.rows.bytes() == 0);
  CHECK(not_kept.rows.rows_not_kept() == 2);
}

TEST_CASE("a patch that is bright at one end sends as much as a uniform one") {
  Rows r(1u << 30);
  uint32_t compared = 0;
  for (uint32_t patch = 0; patch < r.mesh.patches.size(); patch += 3) {
    const Patch& p = r.mesh.patches[patch];
    if (p.last_point - p.first_point < 8) continue;
    std::vector<float> shares(p.last_point - p.first_point, 0.1f);
    for (size_t i = 0; i < shares.size(); i += 3) shares[i] = 2;
    const double even = r.power(r.shoot(patch));
    const std::vector<float> uneven = r.shoot(patch, shares);
    CHECK(r.power(uneven) == doctest::Approx(even).epsilon(0.15));
    ++compared;
  }
  CHECK(compared > 3);
}

TEST_CASE("cells of a patch send the same light as the patch") {
  Rows r(0);
  for (uint32_t patch = 0; patch < r.mesh.patches.size(); ++patch) {
    const Shooter shooter = patch_shooter(r.mesh, patch, Rgb{1});
    double area = 0;
    for (const ShooterCell& c : shooter_cells(r.mesh, patch, shooter))
      area += double(c.area) * double(c.share);
    CHECK(area == doctest::Approx(double(shooter.area())).epsilon(1e-5));
  }
}
