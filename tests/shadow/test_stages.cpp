// Tests each stage of certified visibility alone: cluster, facet lists, cells, certificates, masks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "light/irradiance.h"
#include "one_source.h"
#include "shadow/gather_facets.h"
#include "shadow/settle_part.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Quad plate(float x0, float x1, float y0, float y1, float z) {
  return {Vec3{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

// Returns small squares in rows, half a metre above the floor.
std::vector<Quad> crumbs(int n, float spacing) {
  std::vector<Quad> q;
  for (int i = 0; i < n * n; ++i) {
    const float x = spacing * (float(i % n) - 0.5f * float(n));
    const float y = spacing * (float(i / n) - 0.5f * float(n));
    q.push_back(plate(x, x + 0.3f * spacing, y, y + 0.3f * spacing, 0.5f));
  }
  return q;
}

}  // namespace

TEST_CASE("cluster: its body contains all receivers, and for a part no more than needed") {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Random r(seed + 77);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 33);
    ShadowCluster cluster;
    cluster.set(receivers);
    std::vector<uint32_t> members;
    for (uint32_t i = 0; i < receivers.size(); i += 2) members.push_back(i);
    const ReceiverHull part = hull_of(cluster, members);
    for (const ReceiverHull* hull : {static_cast<const ReceiverHull*>(&cluster.hull), &part}) {
      Vec3d lower = hull->corners[0], upper = lower;
      for (int i = 0; i < hull->count; ++i) {
        lower = min(lower, hull->corners[size_t(i)]);
        upper = max(upper, hull->corners[size_t(i)]);
      }
      const double slack = hull->slack + 1e-9;
      for (size_t i = 0; i < receivers.size(); i += hull == &part ? 2 : 1)
        for (size_t a = 0; a < 3; ++a) {
          CHECK(double(receivers[i].origin[a]) >= lower[a] - slack);
          CHECK(double(receivers[i].origin[a]) <= upper[a] + slack);
        }
    }
    CHECK(part.is_flat >= cluster.hull.is_flat);
  }
}

TEST_CASE("cluster: halves do not depend on the order and are separated along the longest axis") {
  const std::vector<ShadowReceiver> receivers = receivers_on_floor(6, 0.1f);
  std::vector<ShadowReceiver> longer = receivers;
  for (ShadowReceiver& r : longer) r.origin.x *= 3;
  ShadowCluster cluster;
  cluster.set(longer);
  std::vector<uint32_t> a, b;
  for (uint32_t i = 0; i < 36; ++i) {
    a.push_back(i);
    b.push_back(35 - i);
  }
  const size_t half = halve_members(cluster, a);
  CHECK(half == 18);
  CHECK(halve_members(cluster, b) == half);
  CHECK(std::set<uint32_t>(a.begin(), a.begin() + 18) ==
        std::set<uint32_t>(b.begin(), b.begin() + 18));
  for (size_t i = 0; i < 36; ++i) CHECK((longer[a[i]].origin.x < 0.8f) == (i < half));
}

TEST_CASE("cluster: unoccluded light of all shapes agrees with the closed form") {
  Random r(6);
  for (int k = 0; k < 50; ++k) {
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 5);
    ShadowCluster cluster;
    cluster.set(receivers);
    CHECK_FALSE(cluster.has_own_horizons);
    const FlatSource flat = random_source(r);
    const SphereSource sphere{{0, 0.2, 2}, 0.3};
    std::vector<float> of_flat, of_sphere;
    unoccluded_light(cluster, flat, of_flat);
    unoccluded_light(cluster, sphere, of_sphere);
    for (size_t i = 0; i < receivers.size(); ++i) {
      const Vec3d x(receivers[i].position), n(receivers[i].normal);
      const bool is_before = dot(flat.plane.normal, x - flat.plane.origin) > 1e-5;
      const double expected = is_before ? polygon_irradiance(flat.corners(), x, n, Sides::both) : 0;
      CHECK(double(of_flat[i]) == doctest::Approx(expected).epsilon(1e-5));
      CHECK(double(of_sphere[i]) ==
            doctest::Approx(sphere_irradiance(sphere.centre, sphere.radius, x, n)));
    }
  }
}

TEST_CASE("gathering: a short list is one part with exactly the facets in between") {
  OneSource one(receivers_on_floor(8, 0.02f));
  BruteForceScene scene;
  scene.facets = {plate(-0.1f, 0.1f, -0.1f, 0.1f, 1), plate(3, 4, 3, 4, 1),
                  plate(-1, 1, -1, 1, 2.5f)};
  GatherMemory memory;
  const FlatCell whole = visible_part(one.source, one.cluster.hull);
  divide_flat(one.task(), one.members, one.cluster.hull, whole, scene, memory, one.counters);
  REQUIRE(memory.parts.all().size() == 1);
  const SourcePart& part = memory.parts.all()[0];
  CHECK(part.members.size() == 64);
  CHECK(part.is_whole);
  CHECK(part.is_complete);
  CHECK_FALSE(part.is_over_budget);
  REQUIRE(part.facets.size() == 1);
  CHECK(part.facets[0].id == 0);
  CHECK(one.counters.gathers == 1);
}

TEST_CASE("gathering: too long lists divide receivers and source; each pair stays in one part") {
  for (const float spacing : {0.3f, 0.001f}) {  // receivers far apart, and close together
    OneSource one(receivers_on_floor(8, spacing));
    BruteForceScene scene;
    scene.facets = crumbs(24, 0.1f);
    one.options.longest_list = spacing > 0.1f ? 100 : 5;
    one.options.most_halvings = 12;
    GatherMemory memory;
    const FlatCell whole = visible_part(one.source, one.cluster.hull);
    divide_flat(one.task(), one.members, one.cluster.hull, whole, scene, memory, one.counters);
    CHECK(memory.parts.all().size() > 1);
    std::vector<double> area(64, 0);
    bool is_any_whole = false;
    for (const SourcePart& part : memory.parts.all()) {
      CHECK(part.is_complete);
      CHECK(part.facets.size() <= one.options.longest_list);
      is_any_whole = is_any_whole || part.is_whole;
      const double cell = length(cross(part.cell.plane.u, part.cell.plane.v));
      for (const uint32_t m : part.members) area[m] += cell;
    }
    // close together, halving receivers gains nothing, so the source is halved
    if (spacing < 0.1f) CHECK_FALSE(is_any_whole);
    for (const double a : area) CHECK(a == doctest::Approx(1));
    CHECK_FALSE(one.found.is_over_budget());
  }
}

TEST_CASE(
    "gathering: lists over budget are cut, keep the facets that rays hit, and are remembered") {
  OneSource one(receivers_on_floor(8, 0.01f));
  BruteForceScene scene;
  scene.facets = crumbs(20, 0.03f);
  one.options.longest_list = 40;
  one.options.most_found = 10;
  one.options.most_halvings = 0;
  std::vector<uint32_t> met{399, 7, 7};
  one.found.add(met);
  GatherMemory memory;
  const FlatCell whole = visible_part(one.source, one.cluster.hull);
  divide_flat(one.task(), one.members, one.cluster.hull, whole, scene, memory, one.counters);
  REQUIRE(memory.parts.all().size() == 1);
  const std::vector<FacetToAdd>& kept = memory.parts.all()[0].facets;
  CHECK(kept.size() == 10);
  for (const uint32_t id : {7u, 399u})
    CHECK(std::any_of(kept.begin(), kept.end(), [&](const auto& f) { return f.id == id; }));
  CHECK_FALSE(memory.parts.all()[0].is_complete);
  CHECK(memory.parts.all()[0].is_over_budget);
  CHECK(one.found.is_over_budget());
  // no further halving is tried the next time
  one.options.most_halvings = 3;
  one.counters = {};
  divide_flat(one.task(), one.members, one.cluster.hull, whole, scene, memory, one.counters);
  CHECK(one.counters.gathers == 1);
}

TEST_CASE("gathering: close to a sphere there is no list, and receivers are halved") {
  OneSource one(receivers_on_floor(8, 0.2f));
  const SphereSource sphere{{0.7, 0.7, 0.5}, 0.4};
  SourceTask task = one.task();
  task.request = request_for(sphere, one.found);
  BruteForceScene scene;
  scene.facets = {plate(0, 1, 0, 1, 0.05f)};
  GatherMemory memory;
  divide_sphere(task, one.members, one.cluster.hull, scene, memory, one.counters);
  size_t members = 0;
  bool has_complete = false;
  for (const SourcePart& part : memory.parts.all()) {
    members += part.members.size();
    if (!part.is_complete) CHECK(part.facets.empty());
    has_complete = has_complete || part.is_complete;
  }
  CHECK(members == 64);
  CHECK(memory.parts.all().size() > 1);
  CHECK(has_complete);
  CHECK_FALSE(one.found.is_over_budget());
}

TEST_CASE("a rim is the part that rises out of the source's slab within its outline") {
  const FlatSource source = ceiling_source();
  BruteForceScene scene;
  scene.facets = {plate(-0.5f, 0.5f, -0.5f, 0.5f, 2), plate(0, 1, 0, 1, 1)};
  CHECK_FALSE(has_rim(source, 1e-5, 64, scene));
  scene.facets.push_back({Vec3{0, -1, 2}, {0, 1, 2}, {0, 1, 1.9f}, {0, -1, 1.9f}});
  CHECK(has_rim(source, 1e-5, 64, scene));
}

TEST_CASE("source cells cover the source once, and light varies little over each") {
  const FlatSource source{{{-2, -2, 0.3}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}}, {}};
  OneSource one(receivers_on_floor(4, 0.01f), source);
  CellLimits limits;
  std::vector<FlatCell> cells;
  const FlatCell whole = visible_part(source, one.cluster.hull);
  cut_cells(whole, one.cluster.hull, limits, cells);
  CHECK(cells.size() > 8);
  double area = 0;
  std::vector<double> sum(16, 0);
  std::vector<float> light;
  for (const FlatCell& c : cells) {
    area += length(cross(c.plane.u, c.plane.v));
    unoccluded_light(one.cluster, source, c.all_corners(), light);
    for (size_t i = 0; i < 16; ++i) sum[i] += double(light[i]);
  }
  CHECK(area == doctest::Approx(16));
  for (size_t i = 0; i < 16; ++i)
    CHECK(sum[i] == doctest::Approx(double(one.unoccluded[i])).epsilon(1e-5));
  // far away one cell is enough; below the horizon of a flat cluster there is none
  OneSource far(receivers_on_floor(4, 0.01f));
  cells.clear();
  cut_cells(visible_part(far.source, far.cluster.hull), far.cluster.hull, limits, cells);
  CHECK(cells.size() == 1);
  FlatSource below = ceiling_source();
  below.plane.origin.z = -2;
  CHECK(visible_part(below, far.cluster.hull).corner_count == 0);
}

TEST_CASE("certificates: lit, dark, or undecided") {
  OneSource one(receivers_on_floor(4, 0.01f));
  const MaskFrame frame = one.frame();
  const SourceTask task = one.task();
  FacetFlags flags;
  FacetList left;
  const auto answer = [&](const std::vector<Quad>& facets, bool is_complete) {
    const SourceCellTask cell{task, frame, one.unoccluded, 1, is_complete, false};
    return certify(cell, one.cluster.hull, one.list_of(frame, facets), flags, left);
  };
  const Quad all = plate(-2, 2, -2, 2, 1), beside = plate(1, 2, 1, 2, 1);
  const Quad some = plate(-0.1f, 0.1f, -0.1f, 0.1f, 1);
  CHECK(answer({}, true) == Certificate::lit);
  CHECK(answer({}, false) == Certificate::none);  // other facets may hide it
  CHECK(answer({beside}, true) == Certificate::lit);
  CHECK(answer({beside, all}, true) == Certificate::dark);
  CHECK(answer({some, all}, false) == Certificate::dark);  // despite missing facets
  CHECK(answer({beside, some, beside}, true) == Certificate::none);
  CHECK(left.size() == 1);
}

TEST_CASE("certificates: a cluster is halved while its list is long, and every member answered") {
  OneSource one(receivers_on_floor(16, 0.1f));
  one.options.split_above = 4;
  const MaskFrame frame = one.frame();
  const SourceTask task = one.task();
  const SourceCellTask cell{task, frame, one.unoccluded, 1, true, false};
  SettleMemory memory;
  memory.lists[0] = one.list_of(frame, crumbs(8, 0.2f));
  SourceResults results = one.results();
  ReceiverTree tree;
  tree.set(one.cluster, one.members, one.cluster.hull);
  settle_cell(cell, tree, memory, results);
  for (size_t i = 0; i < one.receivers.size(); ++i)
    CHECK(one.sums[i].unoccluded == one.unoccluded[i]);
  CHECK(one.queue.is_empty());
  CHECK(one.counters.masks > 0);
  // halves have shorter lists than all together
  CHECK(one.counters.mask_facets < one.counters.masks * 64 / 2);
}

TEST_CASE(
    "certificates: if only some members of a cluster see a shadow edge, only they get masks") {
  OneSource one(receivers_on_floor(16, 0.1f));
  const MaskFrame frame = one.frame();
  const SourceTask task = one.task();
  const SourceCellTask cell{task, frame, one.unoccluded, 1, true, false};
  SettleMemory memory;
  memory.lists[0] = one.list_of(frame, {plate(-5, 5, 0.7f, 5, 0.02f)});
  SourceResults results = one.results();
  ReceiverTree tree;
  tree.set(one.cluster, one.members, one.cluster.hull);
  settle_cell(cell, tree, memory, results);
  size_t lit = 0, dark = 0;
  for (const CellSum& s : one.sums) {
    lit += s.kinds == answer_bit(ShadowAnswer::lit);
    dark += s.kinds == answer_bit(ShadowAnswer::dark);
  }
  CHECK(lit >= 64);
  CHECK(dark >= 64);
  CHECK(one.counters.masks <= 64);
  CHECK(one.counters.masks + lit + dark == 256);
}

TEST_CASE("receiver tree: halves contain the receivers of their parent, each once") {
  OneSource one(receivers_on_floor(6, 0.1f));
  ReceiverTree tree;
  tree.set(one.cluster, one.members, one.cluster.hull);
  std::vector<uint32_t> nodes{0}, seen;
  while (!nodes.empty()) {
    const uint32_t node = nodes.back();
    nodes.pop_back();
    const std::vector<uint32_t> members(tree.members(node).begin(), tree.members(node).end());
    for (const uint32_t m : members) {
      const Vec3d p(one.receivers[m].origin), d = p - tree.hull(node).centre;
      double farthest = 0;
      for (int i = 0; i < tree.hull(node).count; ++i)
        farthest =
            std::max(farthest, length(tree.hull(node).corners[size_t(i)] - tree.hull(node).centre));
      CHECK(length(d) <= farthest * 1.001 + 1e-6);
    }
    if (members.size() < 2) {
      seen.push_back(members[0]);
      continue;
    }
    const uint32_t halves = tree.halves_of(node);
    CHECK(tree.halves_of(node) == halves);  // not halved again
    CHECK(tree.members(halves).size() + tree.members(halves + 1).size() == members.size());
    nodes.push_back(halves);
    nodes.push_back(halves + 1);
  }
  std::sort(seen.begin(), seen.end());
  CHECK(seen == one.members);
}

TEST_CASE("masks: with a complete list they are the answer") {
  OneSource one({receivers_on_floor(1, 1)});
  one.options.lattice = fine_lattice;
  const MaskFrame frame = one.frame();
  const SourceTask task = one.task();
  const FacetList half = one.list_of(frame, {plate(0, 3, -3, 3, 1)});
  MaskMemory memory;
  double share = 0;
  constexpr int passes = 200;
  for (uint64_t pass = 0; pass < passes; ++pass) {
    const SourceCellTask cell{task, frame, one.unoccluded, 1, true, false};
    const MaskShare seen = mask_share_of(cell, 0, half, pass, memory);
    CHECK(double(seen.share) == doctest::Approx(0.5).epsilon(0.02));
    CHECK(seen.variance > 0);
    share += double(seen.share) / passes;
  }
  CHECK(share == doctest::Approx(0.5).epsilon(1e-3));
  const SourceCellTask cell{task, frame, one.unoccluded, 1, true, false};
  SourceResults results = one.results();
  mask_cell(cell, one.members, half, memory, results);
  CHECK(one.queue.is_empty());
  CHECK(double(one.sums[0].light) ==
        doctest::Approx(0.5 * double(one.unoccluded[0])).epsilon(0.02));
  SourceVisibility answer;
  set_answer(one.sums[0], one.unoccluded[0], answer);
  CHECK(answer.answer == ShadowAnswer::masked);
}

TEST_CASE("masks: with an incomplete list dark samples are answered, open ones wait for rays") {
  OneSource one({receivers_on_floor(1, 1)});
  const MaskFrame frame = one.frame();
  const SourceTask task = one.task();
  const FacetList half = one.list_of(frame, {plate(0, 3, -3, 3, 1)});
  MaskMemory memory;
  for (const bool is_over_budget : {false, true}) {
    const SourceCellTask cell{task, frame, one.unoccluded, 1, false, is_over_budget};
    one.sums.assign(1, {});
    one.queue.clear();
    one.queue.sources.push_back(one.ray_source());
    one.queue.frames.push_back(frame);
    SourceResults results = one.results();
    mask_cell(cell, one.members, half, memory, results);
    CHECK(one.sums[0].light == 0);
    CHECK(one.sums[0].unoccluded == one.unoccluded[0]);
    const size_t passes = is_over_budget ? one.options.masks_with_rays : 1;
    REQUIRE(one.queue.open.size() == passes);
    double light = 0;
    for (const RayQueue::OpenPair& p : one.queue.open) {
      CHECK(p.passes == passes);
      light += double(p.light);
    }
    CHECK(light == doctest::Approx(0.5 * double(one.unoccluded[0])).epsilon(0.02));
    SourceVisibility answer;
    set_answer(one.sums[0], one.unoccluded[0], answer);
    CHECK(answer.answer == ShadowAnswer::mixed);
    CHECK(answer.visible == 0);
  }
}
