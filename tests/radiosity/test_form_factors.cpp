// Form factors compared with closed forms; row sums; reciprocity.
// References: [1] Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11
//   (identical, parallel, opposed rectangles), C-14 (perpendicular rectangles with a common edge).
#include <doctest/doctest.h>

#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "radiosity/form_factors.h"
#include "radiosity/rooms.h"

using namespace troffer;
using namespace troffer::test;

namespace {

double parallel_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, x2 = 1 + x * x, y2 = 1 + y * y;
  return 2 / (pi * x * y) *
         (std::log(std::sqrt(x2 * y2 / (x2 + y * y))) +
          x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
          y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y));
}

// Returns the factor from w × l to h × l, which share the edge of length l.
double perpendicular_factor(double l, double w_length, double h_length) {
  const double h = h_length / l, w = w_length / l, h2 = h * h, w2 = w * w;
  const double r = std::sqrt(h2 + w2);
  return 1 / (pi * w) *
         (w * std::atan(1 / w) + h * std::atan(1 / h) - r * std::atan(1 / r) +
          0.25 * std::log((1 + w2) * (1 + h2) / (1 + w2 + h2) *
                          std::pow(w2 * (1 + w2 + h2) / ((1 + w2) * (w2 + h2)), w2) *
                          std::pow(h2 * (1 + h2 + w2) / ((1 + h2) * (h2 + w2)), h2)));
}

struct Fixture {
  Ready ready;
  RadiosityMesh mesh;
  Fixture(Scene s, const MeshingOptions& o) : ready(std::move(s)), mesh(ready.mesh(o)) {}

  std::vector<Transfer> from_patch(uint32_t patch, const RayBudget& budget = {}) const {
    std::vector<Transfer> t(mesh.points.size());
    TransferScratch scratch;
    transfer(patch_shooter(mesh, patch, Rgb{1}), mesh.points, ready.tracer, budget, 1, 0, t,
             scratch);
    return t;
  }
};

MeshingOptions open_sizes(float element, float patch) {
  MeshingOptions o = sizes(element, patch);
  o.prune_hidden_sides = false;
  return o;
}

// Returns the mean, over the points that `is_receiver` selects, of the factor to all patches that
// `is_shooter` selects.
template <class Shoots, class Receives>
double mean_factor(const Fixture& f, const Shoots& is_shooter, const Receives& is_receiver) {
  double sum = 0, area = 0;
  for (const ElementPoint& p : f.mesh.points)
    if (is_receiver(p)) area += double(p.area);
  for (uint32_t i = 0; i < f.mesh.patches.size(); ++i) {
    if (!is_shooter(f.mesh.points[f.mesh.patches[i].first_point])) continue;
    const std::vector<Transfer> t = f.from_patch(i);
    for (size_t k = 0; k < t.size(); ++k)
      if (is_receiver(f.mesh.points[k]))
        sum += double(t[k].unoccluded.g * t[k].visibility) / pi * double(f.mesh.points[k].area);
  }
  return sum / area;
}

}  // namespace

TEST_CASE("parallel rectangles") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  add_quad(s, grey, {Vec3{0, 0, 1.5f}, {0, 1, 1.5f}, {2, 1, 1.5f}, {2, 0, 1.5f}});
  const Fixture f(std::move(s), open_sizes(0.15f, 0.6f));
  const double got = mean_factor(
      f, [](const ElementPoint& p) { return p.position.z > 1 && p.normal.z < 0; },
      [](const ElementPoint& p) { return p.position.z < 1 && p.normal.z > 0; });
  CHECK(got == doctest::Approx(parallel_factor(2, 1, 1.5)).epsilon(0.003));
}

TEST_CASE("perpendicular rectangles with a common edge") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  add_quad(s, grey, {Vec3{0, 0, 0}, {0, 0, 1.5f}, {2, 0, 1.5f}, {2, 0, 0}});
  const Fixture f(std::move(s), open_sizes(0.1f, 0.6f));
  const double got = mean_factor(
      f, [](const ElementPoint& p) { return p.position.y == 0 && p.normal.y > 0; },
      [](const ElementPoint& p) { return p.position.z == 0 && p.normal.z > 0; });
  // The integrand jumps at the edge, so the mean over elements is accurate to one element's share.
  CHECK(got == doctest::Approx(perpendicular_factor(2, 1, 1.5)).epsilon(0.03));
}

TEST_CASE("row sums in a closed room are 1") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {3, 2, 2.5f});
  SUBCASE("empty") {}
  SUBCASE("with a block that hides some of it") {
    const uint32_t m = add_diffuse(s, Rgb{0.5f});
    for (const uint32_t q : add_box_inside(s, m, {1, 0.7f, 0.4f}, {1.8f, 1.2f, 1.3f}))
      std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);
  }
  const bool is_empty = s.meshes.size() == 6;
  const Fixture f(std::move(s), open_sizes(0.3f, 0.9f));
  std::vector<double> sums(f.mesh.points.size());
  for (uint32_t i = 0; i < f.mesh.patches.size(); ++i) {
    const std::vector<Transfer> t = f.from_patch(i);
    for (size_t k = 0; k < t.size(); ++k)
      sums[k] += double(t[k].unoccluded.g * t[k].visibility) / pi;
  }
  const auto is_in_room = [](const ElementPoint& p) {
    const Vec3 x = p.position + p.normal * 0.001f;
    const bool in_block =
        x.x > 1 && x.x < 1.8f && x.y > 0.7f && x.y < 1.2f && x.z > 0.4f && x.z < 1.3f;
    return x.x > 0 && x.x < 3 && x.y > 0 && x.y < 2 && x.z > 0 && x.z < 2.5f && !in_block;
  };
  double worst = 0;
  size_t count = 0;
  for (size_t k = 0; k < sums.size(); ++k) {
    if (!is_in_room(f.mesh.points[k])) continue;
    ++count;
    worst = std::max(worst, std::abs(sums[k] - 1));
  }
  MESSAGE("largest error of a row sum: " << worst << " of " << count << " points");
  CHECK(count > 300);
  // An empty room is exact except for the point approximation of distant pieces. Otherwise the
  // rays' visibility error dominates.
  CHECK(worst < (is_empty ? 0.005 : 0.06));
}

TEST_CASE("reciprocity") {
  Scene s;
  Random r(7);
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  for (int i = 0; i < 12; ++i) {
    const Vec3 at = Vec3{r.next_float(), r.next_float(), r.next_float()} * 2;
    const Frame frame(sphere_from_square(r.next_vec2()));
    const Vec3 x = frame.tangent * 0.5f, y = frame.bitangent * (0.2f + 0.4f * r.next_float());
    add_quad(s, grey, {at, at + x, at + x + y, at + y});
  }
  const Fixture f(std::move(s), open_sizes(0.04f, 1));
  const size_t n = f.mesh.patches.size();
  REQUIRE(n == 24);
  std::vector<double> power(n * n);  // A_j F_ji
  for (uint32_t i = 0; i < n; ++i) {
    const std::vector<Transfer> t = f.from_patch(i);
    for (size_t k = 0; k < t.size(); ++k)
      power[i * n + f.mesh.points[k].patch] +=
          double(t[k].unoccluded.g * t[k].visibility * f.mesh.points[k].area) / pi;
  }
  double largest = 0;
  for (const double p : power) largest = std::max(largest, p);
  int compared = 0;
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < i; ++j) {
      const double a = power[i * n + j], b = power[j * n + i];
      if (std::max(a, b) < 0.05 * largest) continue;
      ++compared;
      CHECK(a == doctest::Approx(b).epsilon(0.05));
    }
  }
  CHECK(compared > 10);
}

TEST_CASE("spheres and disks shoot their full power") {
  // A closed sphere lit from within: from any inner point, its inside fills the whole hemisphere.
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  s.spheres.push_back({{0, 0, 0}, 2, true, grey, no_light});
  s.disks.push_back({{0, 0, 0.3f}, {0, 0, 1}, 0.5f, grey, no_light});
  const Fixture f(std::move(s), open_sizes(0.25f, 1));
  std::vector<double> sums(f.mesh.points.size());
  double sphere_area = 0, disk_area = 0;
  for (const ElementPoint& p : f.mesh.points)
    (length(p.position) > 1.9f ? sphere_area : disk_area) += 0.5 * double(p.area);
  CHECK(sphere_area == doctest::Approx(4 * pi * 4).epsilon(1e-4));
  CHECK(disk_area == doctest::Approx(pi * 0.25).epsilon(1e-4));
  for (uint32_t i = 0; i < f.mesh.patches.size(); ++i) {
    const std::vector<Transfer> t = f.from_patch(i);
    for (size_t k = 0; k < t.size(); ++k)
      sums[k] += double(t[k].unoccluded.g * t[k].visibility) / pi;
  }
  double worst = 0, mean = 0, count = 0;
  for (size_t k = 0; k < sums.size(); ++k) {
    const ElementPoint& p = f.mesh.points[k];
    if (length(p.position) > 1.9f && dot(p.position, p.normal) > 0) continue;  // outside
    worst = std::max(worst, std::abs(sums[k] - 1));
    mean += sums[k];
    ++count;
  }
  MESSAGE("sphere: mean row sum " << mean / count << ", largest error " << worst);
  CHECK(mean / count == doctest::Approx(1).epsilon(0.01));
  CHECK(worst < 0.1);
}

TEST_CASE("curved patches of many pieces use the disc approximation") {
  // A fine half cylinder, joined into few sheets and closed by a flat chord.
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  Mesh m;
  m.material = grey;
  constexpr uint32_t around = 60, along = 40;
  for (uint32_t i = 0; i <= around; ++i)
    for (uint32_t j = 0; j <= along; ++j) {
      const float a = pi_f * float(i) / around;
      m.positions.push_back({std::cos(a), 0.1f * float(j) - 2, std::sin(a)});
    }
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < along; ++j) {
      const uint32_t v = i * (along + 1) + j;
      m.triangles.push_back({v, v + 1, v + along + 1});
      m.triangles.push_back({v + 1, v + along + 2, v + along + 1});
    }
  s.meshes.push_back(m);
  add_quad(s, grey, {Vec3{-1, -2, 0}, {1, -2, 0}, {1, 2, 0}, {-1, 2, 0}});
  MeshingOptions o = open_sizes(0.3f, 1.2f);
  o.join_angle_deg = 30;
  const Fixture f(std::move(s), o);
  bool has_many = false;
  for (const Sheet& sheet : f.mesh.sheets)
    has_many |= sheet.last_piece - sheet.first_piece > max_exact_pieces;
  CHECK(has_many);
  CHECK(f.mesh.element_count < 1500);
  const ElementPoint* middle = nullptr;
  size_t index = 0;
  for (size_t k = 0; k < f.mesh.points.size(); ++k) {
    const ElementPoint& p = f.mesh.points[k];
    if (p.position.z == 0 && p.normal.z > 0 && length(p.position) < 0.3f && middle == nullptr) {
      middle = &p;
      index = k;
    }
  }
  REQUIRE(middle != nullptr);
  double sum = 0;
  for (uint32_t i = 0; i < f.mesh.patches.size(); ++i) {
    const std::vector<Transfer> t = f.from_patch(i);
    sum += double(t[index].unoccluded.g * t[index].visibility) / pi;
  }
  CHECK(sum > 0.85);  // the ends are open
  CHECK(sum < 1.02);
}
