#include "transport/light_training.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "base/units.h"
#include "transport/bsdf_at.h"
#include "transport/costs.h"
#include "transport/purposes.h"
#include "transport/two_sides.h"
#include "transport/walk.h"

namespace troffer {

namespace {

// Light samples at the first surface that scatters, and at the second. Most paths take most of
// their samples at the first.
constexpr uint32_t samples_at_first = 16, samples_at_second = 4;
constexpr size_t most_at_infinity = 16;  // lights; more would make too many parts
// Vertices of a path, with mirrors and glass on its way. By judgement: two panes with two sides
// each leave four.
constexpr uint32_t most_vertices = 8;
// Limits the memory of observations to about 60 MB. Four times as many gain little.
constexpr size_t most_batches = 256;

struct Lesson {
  std::vector<LightObservation> observations;
  std::vector<Ray> rays;  // of observations with light, in the same order
  Counters counters;
};

// Chooses a light and the numbers of a point on it. Each part of the lights is as probable, so
// those that cannot light v are known to bring nothing. Sets pmf: of the light, given its part; 0:
// no light.
LightObservation choose_light(const PreparedScene& scene, const Vertex& v, bool both_sides,
                              const SobolGroup& numbers, float& pmf) {
  const Vec3 x = v.surface.position, n = v.geometric_normal;
  const std::vector<uint32_t>& infinite = scene.primitives.at_infinity();
  LightObservation o{x, n, 0, numbers.get2(), 0};
  const bool has_placed = infinite.size() < scene.primitives.size();
  const float target = numbers.get(2) * float(infinite.size() + (has_placed ? 1 : 0));
  const auto part = size_t(target);
  pmf = 1;
  if (part < infinite.size()) {
    o.primitive = infinite[part];
    return o;
  }
  const LightChoice c = scene.light_tree.choose_placed(
      x, n, both_sides, std::min(target - float(part), one_minus_epsilon));
  const float chance = scene.light_tree.chance_of_placed(x, n, both_sides);
  o.primitive = c.primitive;
  pmf = chance > 0 ? c.pmf / chance : 0;
  return o;
}

// Adds the light sample with these numbers at v. Its light is that without occlusion, and its ray
// is added if there is any.
void add_sample(const PreparedScene& scene, const Vertex& v, bool both_sides,
                const SobolGroup& numbers, Lesson& out) {
  float pmf = 0;
  LightObservation o = choose_light(scene, v, both_sides, numbers, pmf);
  LightSample s;
  if (pmf > 0 &&
      sample(scene.scene, scene.primitives[o.primitive], v.surface.position, o.square, s)) {
    const float cosine = dot(s.wi, v.frame.normal);
    const float facing = both_sides ? std::abs(cosine) : std::max(cosine, 0.0f);
    o.light = luminance(s.radiance) * facing / (s.pdf_solid_angle * pmf);
  }
  if (!std::isfinite(o.light)) o.light = 0;
  if (o.light > 0) out.rays.push_back(shadow_ray_to(v.surface, s));
  out.observations.push_back(o);
}

// Tests which samples arrive.
void test_samples(const PreparedScene& scene, Lesson& lesson, size_t first) {
  std::vector<uint8_t> is_occluded(lesson.rays.size());
  PaneFactors factors;
  scene.tracer.occluded(lesson.rays, is_occluded, Coherence::coherent, factors);
  size_t ray = 0;
  for (size_t i = first; i < lesson.observations.size(); ++i) {
    float& light = lesson.observations[i].light;
    if (!(light > 0)) continue;
    light *= is_occluded[ray] != 0 ? 0.0f : luminance(factors[ray]);
    ++ray;
  }
  lesson.counters.shadow_rays += lesson.rays.size();
  lesson.rays.clear();
}

// Samples lights where a walk has arrived, and sends it on. Returns false if it ends.
bool visit(const PreparedScene& scene, const Hit& hit, Walk& walk, Lesson& out) {
  Vertex v;
  arrive_at(scene.scene, hit, walk, v);
  Bsdf bsdf = bsdf_at(scene, v);
  if (has_two_sides(bsdf)) choose_side(walk, v, bsdf);
  if (!is_purely_delta(bsdf)) {
    const uint32_t n = walk.scatterings == 0 ? samples_at_first : samples_at_second;
    for (uint32_t j = 0; j < n; ++j)
      add_sample(scene, v, bsdf.has_transmission,
                 SobolGroup(walk.stream, purpose_light(walk.vertex), walk.sample * n + j), out);
  }
  return step(walk, v, bsdf, lobe_number(walk), direction_number(walk)) && walk.scatterings <= 1 &&
         walk.vertex < most_vertices;
}

Lesson learn_from(const PreparedScene& scene, const ViewingRays& rays) {
  Lesson lesson;
  lesson.counters.viewing_rays += rays.size();
  std::vector<Walk> walks;
  WalkScratch trace;
  start_walks(rays, walks);
  for (Coherence c = Coherence::coherent; !walks.empty(); c = Coherence::none) {
    trace_walks(scene.tracer, walks, c, trace, lesson.counters);
    const size_t first = lesson.observations.size();
    size_t alive = 0;
    for (size_t i = 0; i < walks.size(); ++i)
      if (trace.hits[i].is_valid() && visit(scene, trace.hits[i], walks[i], lesson))
        walks[alive++] = walks[i];
    walks.resize(alive);
    test_samples(scene, lesson, first);
  }
  return lesson;
}

}  // namespace

bool may_learn_lights(const PreparedScene& scene) {
  const std::vector<uint32_t>& infinite = scene.primitives.at_infinity();
  return !infinite.empty() && infinite.size() <= most_at_infinity &&
         (scene.primitives.size() > 1 ||
          has_square_of_direction(scene.scene, scene.primitives[infinite[0]]));
}

std::shared_ptr<const LearnedLights> learn_lights(
    const PreparedScene& scene, const std::function<ViewingRays(uint32_t i)>& batch, double budget,
    int threads, Counters& counters) {
  std::vector<Lesson> lessons(1);
  lessons[0] = learn_from(scene, batch(0));
  const double cost = std::max(cost_of(lessons[0].counters), 1.0);
  lessons.resize(size_t(std::clamp(budget / cost, 1.0, double(most_batches))));
  parallel_for(lessons.size() - 1, threads,
               [&](size_t i) { lessons[i + 1] = learn_from(scene, batch(uint32_t(i + 1))); });
  std::vector<LightObservation> all;
  for (Lesson& l : lessons) {
    all.insert(all.end(), l.observations.begin(), l.observations.end());
    counters += l.counters;
    l = {};
  }
  return std::make_shared<const LearnedLights>(scene.scene, scene.primitives, scene.light_tree,
                                               std::move(all));
}

}  // namespace troffer
