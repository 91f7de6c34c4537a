// Tests source selection in small rooms: sums of light, and the expected sources.
#include "kj92/source_selection.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "radiosity/rooms.h"
#include "radiosity/source_contributions.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

RadiosityOptions coarse(uint32_t stored = 4) {
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  o.stored_per_point = stored;
  o.unshot_fraction = 0.05f;
  return o;
}

void add_lamp(Scene& s, const Vec3& at, float size, Rgb radiance) {
  const uint32_t q =
      add_quad(s, add_diffuse(s, Rgb{0}),
               {at, at + Vec3{0, size, 0}, at + Vec3{size, size, 0}, at + Vec3{size, 0, 0}});
  make_light(s, q, radiance);
}

void add_table(Scene& s, float height = 1) {
  const uint32_t grey = add_diffuse(s, Rgb{0.3f});
  add_quad(s, grey, {Vec3{1, 1, height}, {2.5f, 1, height}, {2.5f, 2, height}, {1, 2, height}});
  add_quad(s, grey,
           {Vec3{1, 1, height - 0.05f},
            {1, 2, height - 0.05f},
            {2.5f, 2, height - 0.05f},
            {2.5f, 1, height - 0.05f}});
}

// A room of 4 × 3 × 2.5 m with a table: light 0 is large, 1 and 2 are weaker and coloured.
Scene three_lamps() {
  Scene s = lit_room(0.5f);
  add_lamp(s, {0.2f, 0.3f, 2.3f}, 0.4f, {9, 3, 1});
  add_lamp(s, {3.2f, 2.3f, 2.2f}, 0.3f, {1, 4, 9});
  add_table(s);
  return s;
}

// A room lit indirectly: a lamp in a bowl shines at the ceiling, above a table.
Scene uplight() {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.7f}), {0, 0, 0}, {4, 3, 2.5f});
  const uint32_t q = add_quad(
      s, add_diffuse(s, Rgb{0.2f}),
      {Vec3{0.3f, 1.2f, 2.2f}, {0.8f, 1.2f, 2.2f}, {0.8f, 1.7f, 2.2f}, {0.3f, 1.7f, 2.2f}});
  make_light(s, q, Rgb{60});
  add_table(s);
  return s;
}

struct Selected {
  Selected(Scene scene, const RadiosityOptions& radiosity = coarse(),
           const SelectionOptions& options = {}, int threads = 2)
      : ready(std::move(scene)),
        solution(ready.solve(radiosity)),
        selection(solution, ready.tracer, ready.lights, options, threads, StopFlag{false}) {}
  SourceSelection again(const SelectionOptions& options, int threads = 2) const {
    return SourceSelection(solution, ready.tracer, ready.lights, options, threads, StopFlag{false});
  }
  Ready ready;
  RadiositySolution solution;
  SourceSelection selection;
};

// Returns the patch at one side of a triangle.
uint32_t patch_at(const Selected& s, uint32_t mesh, uint32_t triangle, bool is_back = false) {
  Vec3 weights;
  const uint32_t f =
      fragment_at(s.ready.scene, s.solution.mesh, mesh, triangle, 0.3f, 0.3f, {}, is_back, weights);
  REQUIRE(f != no_fragment);
  const uint32_t point =
      s.solution.mesh.element_points[s.solution.mesh.fragments[f].element][is_back];
  REQUIRE(point != no_point);
  return s.solution.mesh.points[point].patch;
}

const TreatedSource* find(const SourceSelection& s, uint32_t patch, uint32_t source) {
  for (const TreatedSource& t : s.of_patch(patch))
    if (t.source == source) return &t;
  return nullptr;
}

// Returns what a source gives to a point. is_kept: true if the point's list contains it.
StoredContribution given(const Selected& s, uint32_t source, uint32_t point, bool& is_kept) {
  for (const StoredContribution& c : s.solution.contributions(point))
    if (c.source == source) {
      is_kept = true;
      return c;
    }
  is_kept = false;
  StoredContribution out;
  TransferScratch scratch;
  source_contributions(s.ready.tracer, s.ready.lights, s.solution, source, {&point, 1}, {&out, 1},
                       scratch);
  return out;
}

struct Sums {
  uint32_t corners = 0, treated = 0, patches = 0, inexact = 0;
};

// Checks at every knot of every fragment side that general radiosity plus treated sources equal the
// total.
Sums check_sums(const Selected& s, const SourceSelection& selection) {
  Sums sums;
  const RadiosityMesh& mesh = s.solution.mesh;
  for (uint32_t f = 0; f < mesh.fragments.size(); ++f)
    for (const bool is_back : {false, true}) {
      const uint32_t own = mesh.element_points[mesh.fragments[f].element][is_back];
      if (own == no_point) continue;
      for (size_t k = 0; k < knots_per_fragment; ++k) {
        Interpolation at;
        interpolate_at_knot(mesh, f, k, is_back, at);
        REQUIRE(!at.weights().empty());
        Vec3 corners{1.0f / 3};
        if (k < 3) corners = {k == 0 ? 1.0f : 0.0f, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f};
        const GeneralIrradiance general = selection.general(f, is_back, corners);
        Rgb sum = general.direct + general.indirect, wanted;
        bool is_exact = true;
        for (const PointWeight& w : at.weights()) {
          const Rgb all = s.solution.irradiance(w.point);
          wanted += all * w.weight;
          if (luminance(all) > 0) wanted += s.solution.ambient * w.weight;
        }
        for (const TreatedSource& t : selection.of_patch(mesh.points[own].patch)) {
          for (const PointWeight& w : at.weights()) {
            bool is_kept = false;
            sum += given(s, t.source, w.point, is_kept).received * w.weight;
            is_exact &= is_kept || s.solution.is_light(t.source);
          }
          ++sums.treated;
          sums.patches += !s.solution.is_light(t.source);
        }
        ++sums.corners;
        sums.inexact += !is_exact;
        for (size_t c = 0; c < 3; ++c) {
          CHECK(general.direct[c] >= 0);
          CHECK(general.indirect[c] >= 0);
          const double scale = double(wanted[c]) + double(s.solution.mean_irradiance);
          CHECK(double(sum[c]) >= double(wanted[c]) - 1e-5 * scale);
          // Contributions of patches that are not stored are computed again and may differ by
          // noise.
          CHECK(double(sum[c]) <= double(wanted[c]) + (is_exact ? 1e-5 : 0.05) * scale);
        }
      }
    }
  return sums;
}

bool is_same(const SourceSelection& a, const SourceSelection& b, const RadiositySolution& s) {
  for (uint32_t p = 0; p < s.mesh.patches.size(); ++p) {
    const auto x = a.of_patch(p), y = b.of_patch(p);
    if (x.size() != y.size()) return false;
    for (size_t i = 0; i < x.size(); ++i)
      if (x[i].source != y[i].source ||
          x[i].source_class.treatment != y[i].source_class.treatment ||
          x[i].source_class.share != y[i].source_class.share)
        return false;
  }
  for (uint32_t f = 0; f < s.mesh.fragments.size(); ++f)
    for (const bool is_back : {false, true}) {
      const GeneralIrradiance x = a.general(f, is_back, {0.2f, 0.3f, 0.5f}),
                              y = b.general(f, is_back, {0.2f, 0.3f, 0.5f});
      if (std::memcmp(&x, &y, sizeof x) != 0) return false;
    }
  return true;
}

}  // namespace

TEST_CASE(
    "selected plus general light equals all light of the preprocessing, at every corner of every "
    "patch") {
  for (const uint32_t stored : {1u, 4u}) {
    const Selected s(three_lamps(), coarse(stored));
    const Sums sums = check_sums(s, s.selection);
    CAPTURE(stored);
    CHECK(sums.corners > 500);
    CHECK(sums.treated > 500);
    if (stored != 4) continue;
    for (const SourceSelection& other :
         {s.again({false, {}, true, false, {}}), s.again({true, {}, false, false, {}}),
          s.again({true, {}, true, true, {1}}), s.again({false, {}, true, true, {0, 2}})})
      check_sums(s, other);
  }
}

TEST_CASE("selected plus general light is complete with bright patches among the sources too") {
  RadiosityOptions o = coarse(8);
  o.tolerance = 1e-3f;
  const Selected s(uplight(), o);
  const Sums sums = check_sums(s, s.selection);
  CHECK(sums.patches > 100);
  MESSAGE("corners " << sums.corners << ", treated patches at them " << sums.patches
                     << ", of which not kept somewhere " << sums.inexact);
}

TEST_CASE("source lists are sorted, contain existing sources, and leave out general light") {
  const Selected s(uplight(), coarse(8));
  for (uint32_t p = 0; p < s.solution.mesh.patches.size(); ++p) {
    uint32_t last = no_source;
    for (const TreatedSource& t : s.selection.of_patch(p)) {
      CHECK((last == no_source || t.source > last));
      last = t.source;
      CHECK(t.source < s.solution.light_count + s.solution.mesh.patches.size());
      CHECK(t.source_class.treatment != SourceTreatment::general);
      if (s.solution.is_light(t.source)) continue;
      CHECK(s.solution.patch_of(t.source) != p);
      CHECK(t.source_class.treatment == SourceTreatment::sampled);
    }
  }
}

TEST_CASE("a strong source that is wholly hidden is never sampled, only probed") {
  // Under a slab that reaches from wall to wall hangs a lamp; a brighter one hangs above it.
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {4, 3, 2.5f});
  const uint32_t slab = add_diffuse(s, Rgb{0.5f});
  add_quad(
      s, slab,
      {Vec3{-0.5f, -0.5f, 1.2f}, {4.5f, -0.5f, 1.2f}, {4.5f, 3.5f, 1.2f}, {-0.5f, 3.5f, 1.2f}});
  add_lamp(s, {1, 1, 2.4f}, 1, Rgb{100});
  add_lamp(s, {2, 1, 1.1f}, 0.5f, Rgb{5});
  const Selected r(std::move(s), coarse(4));
  uint32_t probed = 0;
  for (uint32_t p = 0; p < r.solution.mesh.patches.size(); ++p) {
    const Patch& patch = r.solution.mesh.patches[p];
    bool is_below = true;
    for (uint32_t i = patch.first_point; i < patch.last_point; ++i)
      is_below &= r.solution.mesh.points[i].position.z < 0.9f;
    if (!is_below) continue;
    if (const TreatedSource* t = find(r.selection, p, 0)) {
      CHECK(t->source_class.view == SourceView::occluded);
      CHECK(t->source_class.treatment == SourceTreatment::probed);
      ++probed;
    }
  }
  CHECK(probed > 4);
}

TEST_CASE("a weak source with a visible shadow edge is sampled") {
  // The weak lamp is just above a screen's edge; the strong one lights the whole floor evenly.
  Scene s;
  const uint32_t floor =
      add_quad(s, add_diffuse(s, Rgb{0}), {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add_lamp(s, {0, 0, 30}, 4, Rgb{100});
  add_lamp(s, {1.95f, 1.95f, 2}, 0.1f, Rgb{20});
  add_quad(s, 0, {Vec3{2, 0, 1}, {4, 0, 1}, {4, 4, 1}, {2, 4, 1}});
  // The screen hides as much of the strong lamp, which is sampled for that reason. Only the weak
  // lamp's share matters here.
  RadiosityOptions o = coarse(4);
  o.meshing = sizes(0.5f, 1);
  const Selected r(std::move(s), o);
  uint32_t sampled = 0;
  for (uint32_t p = 0; p < r.solution.mesh.patches.size(); ++p)
    if (const TreatedSource* t = find(r.selection, p, 1)) {
      const bool is_weak = t->source_class.share < SelectionThresholds{}.major_share;
      sampled += is_weak && t->source_class.treatment == SourceTreatment::sampled;
    }
  MESSAGE("patches where the weak source is sampled for its edge: " << sampled);
  CHECK(sampled > 0);
  CHECK(floor == 0);
}

TEST_CASE("open floors under one lamp: nothing is sampled, everything is probed") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add_lamp(s, {1.5f, 1.5f, 2}, 1, Rgb{10});
  const Selected r(std::move(s));
  for (const uint32_t triangle : {0u, 1u}) {
    const uint32_t p = patch_at(r, 0, triangle);
    REQUIRE(r.selection.of_patch(p).size() == 1);
    const SourceClass c = r.selection.of_patch(p)[0].source_class;
    CHECK(c.view == SourceView::visible);
    CHECK(c.treatment == SourceTreatment::probed);
    CHECK(c.least_visibility == 1);
  }
}

TEST_CASE("selection can be restricted and switched off") {
  const Selected s(three_lamps());
  const SourceSelection only = s.again({true, {}, true, true, {2}});
  const SourceSelection none = s.again({true, {}, true, true, {}});
  const SourceSelection all = s.again({false, {}, true, false, {}});
  uint32_t found = 0;
  for (uint32_t p = 0; p < s.solution.mesh.patches.size(); ++p) {
    CHECK(none.of_patch(p).empty());
    for (const TreatedSource& t : only.of_patch(p)) CHECK(t.source == 2);
    found += uint32_t(only.of_patch(p).size());
    REQUIRE(all.of_patch(p).size() == 3);
    for (uint32_t e = 0; e < 3; ++e) {
      CHECK(all.of_patch(p)[e].source == e);
      CHECK(all.of_patch(p)[e].source_class.treatment == SourceTreatment::sampled);
    }
  }
  CHECK(found > 0);
  // If all lights are sampled, none of their light remains in the general radiosity.
  for (uint32_t f = 0; f < s.solution.mesh.fragments.size(); ++f)
    CHECK(all.general(f, false, {0.2f, 0.3f, 0.5f}).direct.is_black());
}

TEST_CASE("the same selection for any number of threads") {
  const Selected s(uplight(), coarse(8));
  for (const int threads : {1, 3, 5}) CHECK(is_same(s.selection, s.again({}, threads), s.solution));
}

TEST_CASE("nearly empty scenes") {
  Scene dark = lit_room(0.5f);
  dark.lights[0].radiance = Rgb{0};
  Scene no_lamp;
  add_quad(no_lamp, add_diffuse(no_lamp, Rgb{0.5f}),
           {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  Scene slivers = lit_room(0.5f);
  add_quad(slivers, 0, {Vec3{1, 1, 1}, {2, 1, 1}, {2, 1, 1}, {1, 1, 1}});
  add_quad(slivers, 0, {Vec3{1, 1, 1}, {3, 1, 1}, {3, 1.000001f, 1}, {1, 1.000001f, 1}});
  for (const Scene& scene : {Scene{}, dark, no_lamp, slivers}) {
    const Selected s(scene);
    for (uint32_t f = 0; f < s.solution.mesh.fragments.size(); ++f)
      for (const bool is_back : {false, true}) {
        const GeneralIrradiance g = s.selection.general(f, is_back, {0.2f, 0.3f, 0.5f});
        CHECK(is_finite(g.direct + g.indirect));
      }
  }
}
