#include "gather/gather_walks.h"

#include <algorithm>
#include <span>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/warp.h"
#include "transport/bsdf_at.h"
#include "transport/two_sides.h"

namespace troffer {

namespace {

// Note of walks that come from a matte surface. They add neither direct light nor light from mirror
// images, which is computed elsewhere.
constexpr uint32_t note_from_matte = MirrorImages::note_from_matte;

// Thresholds of Russian roulette where a ray meets gloss. If the light carried is below them, a
// light is sampled, or the ray continued, with a probability in proportion to it. The gloss of
// varnish or plastics contributes about a twentieth of the surface's light, so its noise matters
// less. The light of narrow gloss arrives by few rays, so its thresholds are lower. Measured:
// docs/log/cells.md.
constexpr float least_of_light = 0.25f, least_of_ray = 0.5f, least_of_narrow_ray = 0.1f;
constexpr float least_by_width = 8;  // threshold over alpha squared

struct ChancesOfGloss {
  float of_light = 1, of_ray = 1;

  ChancesOfGloss(const Walk& walk, const Bsdf& specular, float cosine, bool is_of_rows) {
    const float least = least_by_width * sqr(glossy_alpha(specular));
    const Rgb carried = walk.throughput * albedo(specular, cosine);
    of_light = chance_of_spawning(walk, carried, std::clamp(least, 1e-6f, least_of_light));
    of_ray = chance_of_spawning(
        walk, carried,
        is_of_rows ? least_of_narrow_ray : std::clamp(least, least_of_narrow_ray, least_of_ray));
  }
};

}  // namespace

CellHit cell_hit_of(const Vertex& v, const Bsdf& bsdf) {
  CellHit hit{v.surface.position, v.frame.normal, v.geometric_normal, v.surface.offset};
  if (bsdf.coat == Bsdf::Coat::none) return hit;
  hit.coated = 2 * v.surface.material + (v.is_front ? 0 : 1);
  hit.uv = v.surface.uv;
  return hit;
}

Vertex vertex_of(const CellHit& hit) {
  Vertex v = make_sensor_vertex(hit.position, hit.horizon, hit.offset);
  v.frame = Frame(hit.normal);
  return v;
}

void set_out(const CellHit& from, const Vec2& number, Walk& walk) {
  const Vec3 local = cosine_hemisphere_from_square(number);
  set_out(from, Frame(from.normal).to_world(local), walk);
  walk.pdf = local.z * inv_pi_f;
}

void set_out(const CellHit& from, const Vec3& wi, Walk& walk) {
  // Directions below the surface occur where the shading normal leans; no light comes from there.
  const bool is_above = dot(wi, from.horizon) > 0;
  if (!is_above) walk.throughput = Rgb{0};
  walk.ray = {};
  walk.ray.origin = from.position + from.horizon * (is_above ? from.offset : -from.offset);
  walk.ray.direction = wi;
  walk.pdf = std::max(dot(wi, from.normal), 0.0f) * inv_pi_f;
  walk.last_position = from.position;
  walk.last_normal = from.horizon;
  walk.last_both_sides = false;
  walk.last_place = note_from_matte;
  // Unfiltered texels, as in paths. A mean over the ray's footprint would include other parts of an
  // image, and texels that no surface shows.
  walk.cone = {};
  ++walk.vertex;
  ++walk.scatterings;
}

void keep_one_of_each(std::vector<GatherArrival>& arrivals) {
  const auto carried = [&](size_t i) { return luminance(arrivals[i].walk.throughput); };
  size_t kept = 0;
  for (size_t first = 0, end = 0; first < arrivals.size(); first = end) {
    float all = 0;
    const auto is_same = [&](const GatherArrival& a) {
      return a.walk.index == arrivals[first].walk.index && a.length == arrivals[first].length;
    };
    while (end < arrivals.size() && is_same(arrivals[end])) all += carried(end++);
    size_t chosen = first;
    if (end - first > 1) {
      if (all == 0) continue;
      float left = lobe_number(arrivals[first].walk) * all;
      while (chosen + 1 < end && left >= carried(chosen)) left -= carried(chosen++);
      while (chosen > first && carried(chosen) == 0) --chosen;  // by rounding
      arrivals[chosen].walk.throughput *= all / carried(chosen);
    }
    arrivals[kept++] = arrivals[chosen];
  }
  arrivals.resize(kept);
}

GatherWalks::GatherWalks(const PreparedScene& scene, std::shared_ptr<const MirrorImages> images)
    : scene_(scene),
      tree_(scene),
      lit_(scene, LightTreeDirect::Options{LightTreeDirect::Competition::none}),
      images_(std::move(images)) {
  if (!images_) return;
  for (const MirrorImages::Image& image : images_->all())
    lit_images_.emplace_back(*image.scene, LightTreeDirect::Options{LightTreeDirect::Competition::none});
}

void GatherWalks::follow(size_t rays, Coherence coherence, GatherScratch& s,
                         Counters& counters) const {
  s.arrivals.clear();
  s.escapes.clear();
  s.light.direct.assign(rays, Rgb{0});
  s.light.indirect.assign(rays, Rgb{0});
  s.light.shadow_rays.assign(rays, 0);
  s.black.assign(rays, 0);
  for (; !s.walks.empty(); coherence = Coherence::none) {
    trace_walks(scene_.tracer, s.walks, coherence, s.trace, counters);
    s.next.clear();
    s.rough.clear();
    arrive_all(s);
    if (s.rough.size() > 0) {
      tree_.queue(s.rough, s.tree, s.light, counters);
      tree_.flush(s.tree, s.light, counters);
    }
    s.walks.swap(s.next);
  }
}

void GatherWalks::see(const Walk& walk, Rgb radiance, float weight, GatherScratch& s) const {
  s.light.direct[walk.index] += walk.throughput * radiance * weight;
}

// True if the walk has to count emission of this light.
bool GatherWalks::counts(const Walk& walk, uint32_t light) const {
  if (walk.last_place == note_from_matte) return false;
  return !images_ || !images_->is_shown(walk.last_place, light);
}

void GatherWalks::note_step(const Walk& before, const Vertex& v, Walk& next) const {
  if (next.panes != before.panes) return;
  next.last_place =
      images_ ? images_->note_beyond(v, before.last_place, next.scatterings != before.scatterings,
                                     next.ray.direction)
              : 0;
}

// Makes all vertices first, so that textures are prefetched before they are read.
void GatherWalks::arrive_all(GatherScratch& s) const {
  const size_t n = s.walks.size();
  s.vertices.resize(std::max(n, s.vertices.size()));
  CheckItems items;
  for (size_t i = 0; i < n; ++i) {
    const Hit& hit = s.trace.hits[i];
    items.at(s.walks[i].index);
    if (!hit.is_valid()) continue;
    Vertex& v = s.vertices[i];
    arrive_at(scene_.scene, hit, s.walks[i], v);
    prefetch_color(scene_.scene, v.surface);
  }
  for (size_t i = 0; i < n; ++i) {
    const Hit& hit = s.trace.hits[i];
    items.at(s.walks[i].index);
    if (hit.is_valid())
      arrive(s.walks[i], hit, s.vertices[i], s);
    else
      leave_scene(s.walks[i], s);
  }
}

void GatherWalks::leave_scene(const Walk& walk, GatherScratch& s) const {
  if (s.keeps_escapes && walk.last_place != note_from_matte)
    s.escapes.push_back({walk.index, walk.ray.direction, walk.throughput});
  for (const uint32_t p : scene_.primitives.at_infinity())
    if (counts(walk, scene_.primitives[p].light))
      see(walk,
          radiance_at_infinity(scene_.scene, scene_.primitives[p], walk.last_position,
                               walk.ray.direction),
          walk.pdf > 0 ? tree_.weight_of_miss(walk, p) : 1, s);
}

void GatherWalks::arrive(const Walk& walk, const Hit& hit, const Vertex& v,
                         GatherScratch& s) const {
  if (v.surface.light >= 0 && counts(walk, uint32_t(v.surface.light)))
    see(walk, emission_at(scene_, v), walk.pdf > 0 ? tree_.weight_of(walk, v) : 1, s);
  ScatteringAt at(scene_, v);
  const Bsdf& bsdf = at.whole();
  const float distance = hit.t * length(walk.ray.direction);
  const bool is_passing = has_two_sides(bsdf);
  if (is_passing) arrive_beyond(walk, v, at.of_two_sides(), distance, s);
  GlossPlace gloss;
  float gloss_weight = 0;
  Rgb reflectance = bsdf.diffuse;
  const bool is_matte = is_lambertian(bsdf, nullptr);
  bool goes_on = false;
  if (!is_matte) {
    const SurfaceScattering& scattering = at.in_parts();
    reflectance = scattering.has_diffuse ? albedo(scattering.diffuse, v.wo.z) : Rgb{0};
    if (s.is_view && scattering.is_wide()) {
      gloss = {v.surface.material, v.is_front, v.surface.uv, v.wo};
      gloss_weight = luminance(walk.throughput * albedo(scattering.specular, v.wo.z));
    } else if (scattering.has_specular) {
      goes_on = true;
      go_on(walk, v, scattering, distance, s);
    }
  }
  if (reflectance.is_black() && !gloss.is_there()) {
    if (goes_on || is_passing) return;
    s.black[walk.index] = walk.length + distance;
    if (!s.is_view) return;
  }
  GatherArrival& a = s.arrivals.emplace_back();
  a.walk = walk;
  a.walk.throughput *= reflectance;
  a.hit = cell_hit_of(v, bsdf);
  a.gloss = gloss;
  a.gloss_weight = gloss_weight;
  a.distance = distance;
  a.length = walk.length + distance;
}

// Continues a walk by gloss: with a sampled light, and along the ray that gloss sends on. Where
// gloss carries little, roulette does either only sometimes.
void GatherWalks::go_on(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering,
                        float distance, GatherScratch& s) const {
  // Roulette needs albedo(), which does not cover panes and clear coats.
  const bool is_spread = scattering.has_rough && !s.is_view;
  const bool is_told = !scattering.specular.is_pane && !scattering.specular.clear.has_lobe();
  const auto light = [&](const Walk& lit, float continuation_ratio) {
    s.rough.walks.push_back(lit);
    s.rough.vertices.push_back(v);
    s.rough.bsdfs.push_back(scattering.specular);
    s.rough.continuation_ratio.push_back(continuation_ratio);
  };
  const auto sets_out = [&](Walk& next) {
    next.length += distance;
    return step(next, v, scattering.specular, lobe_number(walk), direction_number(walk));
  };
  Walk next = walk;
  if (!is_spread || !is_told) {
    if (is_spread) light(walk, 1);
    if (!sets_out(next) || (s.is_view && next.scatterings > 0) || !survives_spawning(next)) return;
    note_step(walk, v, next);
    s.next.push_back(next);
    return;
  }
  const ChancesOfGloss chances(walk, scattering.specular, v.wo.z, s.is_of_rows);
  const float number = spawning_number(walk);
  if (survives(next, chances.of_light, number)) light(next, chances.of_ray / chances.of_light);
  next.throughput = walk.throughput;
  // The complementary number makes both happen together less often than independent ones would.
  if (!survives(next, chances.of_ray, 1 - number) || !sets_out(next)) return;
  next.pdf *= chances.of_ray / chances.of_light;
  note_step(walk, v, next);
  s.next.push_back(next);
}

// Adds an arrival at the far side of a surface that transmits diffusely. Removes that part from
// `bsdf`.
void GatherWalks::arrive_beyond(const Walk& walk, const Vertex& v, Bsdf& bsdf, float distance,
                                GatherScratch& s) const {
  GatherArrival& a = s.arrivals.emplace_back();
  a.walk = walk;
  Vertex far;
  const Bsdf part = take_far_side(v, bsdf, a.walk, far);
  a.walk.throughput *= albedo(part, far.wo.z);
  a.hit = cell_hit_of(far, part);
  a.distance = distance;
  a.length = walk.length + distance;
}

SurfaceScattering GatherWalks::scattering_at(const GlossPlace& p) const {
  return SurfaceScattering(bsdf_at(scene_, p.material, p.uv, p.is_front));
}

Bsdf GatherWalks::coat_at(const CellHit& hit) const {
  const uint32_t material = hit.coated / 2;
  if (material >= scene_.scene.materials.size()) return Bsdf{};
  return bsdf_at(scene_, material, hit.uv, hit.coated % 2 == 0);
}

Bsdf GatherWalks::white_at(const CellHit& hit, float reflectance) const {
  Bsdf white = sensor_bsdf();
  if (const Bsdf coat = coat_at(hit); coat.coat != Bsdf::Coat::none) {
    white = diffuse_part(coat);
    reflectance /= std::max(white.diffuse_mean * coat_share(white, 1) * white.diffuse_mean, 1e-3f);
  }
  white.diffuse = Rgb{reflectance};
  return white;
}

float GatherWalks::leave(const CellHit& from, const Vec2& number, Walk& walk) const {
  set_out(from, number, walk);
  if (from.coated == CellHit::uncoated) return 1;
  const float share = coat_share(coat_at(from), walk.pdf * pi_f);
  walk.throughput *= share;
  return share;
}

void GatherWalks::bounce(std::vector<GatherArrival>& arrivals, GatherScratch& s) const {
  s.walks.clear();
  for (GatherArrival& a : arrivals) {
    const Vec2 number = direction_number(a.walk);
    leave(a.hit, number, a.walk);
    if (!a.walk.throughput.is_black()) s.walks.push_back(a.walk);
  }
}

void GatherWalks::sample_direct_light(const std::vector<GatherArrival>& arrivals, GatherScratch& s,
                                      Counters& counters) const {
  // In groups with the same number of vertices behind them.
  for (size_t first = 0, end = 0; first < arrivals.size(); first = end) {
    while (end < arrivals.size() && arrivals[end].walk.vertex == arrivals[first].walk.vertex) ++end;
    const auto group = std::span(arrivals).subspan(first, end - first);
    light_up_by(lit_, -1, group, s, counters);
    for (size_t i = 0; i < lit_images_.size(); ++i)
      light_up_by(lit_images_[i], int32_t(i), group, s, counters);
  }
}

// image: the one whose lights `tree` has; -1: the scene itself.
void GatherWalks::light_up_by(const LightTreeDirect& tree, int32_t image,
                              std::span<const GatherArrival> arrivals, GatherScratch& s,
                              Counters& counters) const {
  s.rough.clear();
  const FlatMirror* mirror = image < 0 ? nullptr : &images_->all()[size_t(image)].mirror;
  for (const GatherArrival& a : arrivals) {
    if (mirror != nullptr && mirror->above(a.hit.position) <= mirror->tolerance) continue;
    s.rough.walks.push_back(a.walk);
    if (mirror != nullptr)
      s.rough.walks.back().stream =
          hash_of(a.walk.stream, stream::mirror_image_of_arrival, uint64_t(image));
    s.rough.vertices.push_back(vertex_of(a.hit));
    s.rough.bsdfs.push_back(white_at(a.hit, 1));
  }
  if (s.rough.size() == 0) return;
  tree.queue(s.rough, s.tree, s.light, counters);
  tree.flush(s.tree, s.light, counters);
}

}  // namespace troffer
