#include "bake/site_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>

#include "bake/cut_off.h"
#include "base/error.h"
#include "base/frame.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/warp.h"
#include "render/cell_pilot.h"
#include "render/sample_sets.h"
#include "trace/surface.h"
#include "transport/prepared_scene.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

// Limits of a block of sites; a stop takes effect between blocks.
constexpr size_t most_sites_of_block = 64, most_samples_of_block = 4096;
constexpr int most_sets_of_site = 4;
constexpr size_t looks = 8;  // rays from a sample that must all hit backs before it counts as
                             // inside a body
// Samples inside a body are left out if their mean light is at most this share of the others'.
constexpr float most_within = 0.01f;

size_t sites_of_block(int samples) {
  return std::clamp(most_samples_of_block / size_t(std::max(samples, 1)), size_t{1},
                    most_sites_of_block);
}

struct Place {
  Vec3 position, normal;
};

// Samples the weight of corner 0 in proportion to itself: the inverse of the CDF 3t² - 2t³.
float hat_weight(float u) {
  return 0.5f - std::sin(std::asin(std::clamp(1 - 2 * u, -1.0f, 1.0f)) / 3);
}

Place place_on(const Piece& piece, const Vec2& u) {
  float a, b;
  if (piece.is_about_corner) {
    a = hat_weight(u.x);
    b = (1 - a) * u.y;
  } else {
    const Vec2 at = triangle_from_square(u);
    a = at.x;
    b = at.y;
  }
  const float c = std::max(0.0f, 1 - a - b);
  const auto& p = piece.positions;
  const auto& n = piece.normals;
  Place place{p[0] + (p[1] - p[0]) * b + (p[2] - p[0]) * c, n[0] * a + n[1] * b + n[2] * c};
  // An interpolated normal that leans too far would look into the surface.
  const float size = length(place.normal);
  const bool is_sound = size > 0.1f && dot(place.normal, piece.geometric_normal) > 0.5f * size;
  place.normal = is_sound ? place.normal / size : piece.geometric_normal;
  return place;
}

// Pieces of one site, with cumulated weights.
struct Pieces {
  std::vector<Piece> all;
  std::vector<double> sums;

  void take(const SiteList& sites, size_t site) {
    all.clear();
    sums.clear();
    sites.pieces(site, all);
    double sum = 0;
    for (const Piece& p : all) sums.push_back(sum += p.weight);
  }
  bool is_empty() const { return sums.empty() || !(sums.back() > 0); }
  Place place(float pick, const Vec2& u) const {
    const double at = double(pick) * sums.back();
    auto i = size_t(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin());
    i = std::min(i, all.size() - 1);
    // The rest of `pick` is not used: `u` samples the piece.
    return place_on(all[i], u);
  }
};

Ray look(const Place& place, float offset, const Vec2& u) {
  Ray ray;
  ray.origin = place.position + place.normal * offset;
  ray.direction = Frame(place.normal).to_world(cosine_hemisphere_from_square(u));
  return ray;
}

enum class Seen : uint8_t { nothing, front, back };

Seen seen_by(const PreparedScene& scene, const Ray& ray, const Hit& hit) {
  if (!hit.is_valid()) return Seen::nothing;
  const Vec3 normal = surface_at(scene.scene, ray, hit).geometric_normal;
  return dot(normal, ray.direction) > 0 ? Seen::back : Seen::front;
}

// Returns one flag per place: 1 if all rays from it hit backs. A ray that does not ends the test.
std::vector<uint8_t> within_bodies(const PreparedScene& scene, const std::vector<Place>& places,
                                   float offset, uint64_t stream) {
  std::vector<uint8_t> is_within(places.size(), 1);
  std::vector<uint32_t> left(places.size());
  for (uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  for (uint32_t k = 0; k < looks && !left.empty(); ++k) {
    rays.clear();
    for (const uint32_t i : left)
      rays.push_back(
          look(places[i], offset, SobolGroup(hash_combine(stream, i), purpose_camera, k).get2(0)));
    hits.assign(rays.size(), {});
    scene.tracer.closest(rays, hits);
    size_t kept = 0;
    for (size_t j = 0; j < left.size(); ++j) {
      if (seen_by(scene, rays[j], hits[j]) == Seen::back)
        left[kept++] = left[j];
      else
        is_within[left[j]] = 0;
    }
    left.resize(kept);
  }
  return is_within;
}

struct Sum {
  Rgb light{0};
  int samples = 0;
  Rgb mean() const { return samples > 0 ? light / float(samples) : Rgb{0}; }
};

struct Sample {
  LitPlace place;
  Rgb light{0};
  int set = 0;
  bool is_within = false;
};
struct SiteSamples {
  std::vector<Sample> all;
  bool has_area = false;
};

// Removes samples inside bodies if they are dark next to the others. Hitting only backs does not
// prove a body: all walls of a room may face outward.
void leave_out_within(std::vector<Sample>& samples) {
  Sum open, within;
  for (const Sample& s : samples) {
    Sum& sum = s.is_within ? within : open;
    sum.light += s.light;
    ++sum.samples;
  }
  const float before = luminance(open.mean()), behind = luminance(within.mean());
  if (within.samples > 0 && behind <= most_within * before)
    std::erase_if(samples, [](const Sample& s) { return s.is_within; });
}

SiteLight light_of(SiteSamples& site) {
  std::vector<Sample>& samples = site.all;
  if (!site.has_area) return {};
  leave_out_within(samples);
  SiteLight out;
  std::array<Sum, most_sets_of_site> of_set;
  Sum all;
  bool is_open = false;
  const Sample* brightest = samples.empty() ? nullptr : samples.data();
  for (const Sample& s : samples) {
    of_set[size_t(s.set)].light += s.light;
    ++of_set[size_t(s.set)].samples;
    all.light += s.light;
    ++all.samples;
    is_open = is_open || !s.is_within;
    if (s.place.light > brightest->place.light) brightest = &s;
  }
  out.is_known = is_open || luminance(all.light) > 0;
  if (brightest) {
    out.place = brightest->place.position;
    out.normal = brightest->place.normal;
  }
  out.irradiance = all.mean();
  SampleSets sets;
  int used = 0;
  for (const Sum& sum : of_set) {
    if (sum.samples == 0) continue;
    ++used;
    sets.add({}, double(luminance(sum.mean())));
  }
  // Errors are averaged over many sites, so the factor of Student's t for a single site is removed.
  if (used > 1) out.error = float(sets.standard_error() * 1.959964 / t_quantile_95(used - 1));
  return out;
}

struct Worker {
  std::unique_ptr<IntegratorScratch> scratch;
  Pieces pieces;
  std::vector<Place> places;
  std::vector<uint32_t> sites;  // site of each place, within the block
  SensorBatch sensors;
  RadianceBatch out;
  size_t first = 0;  // first site of the block
};

std::string name_of_sensor(const void* worker, size_t i) {
  const Worker& w = *static_cast<const Worker*>(worker);
  return "site " + std::to_string(w.first + w.sites[i]) + ", sample " +
         std::to_string(w.sensors.samples[i]);
}

class Lighting {
 public:
  Lighting(const PreparedScene& scene, const Integrator& integrator, const SiteList& sites,
           const SiteSettings& settings)
      : scene_(scene),
        integrator_(integrator),
        sites_(sites),
        settings_(settings),
        bounds_(bounds(scene.scene)) {}

  void light(size_t block, Worker& w, std::vector<SiteLight>& out, Counters& counters) const {
    w.first = block * sites_of_block(settings_.samples);
    const size_t end = std::min(w.first + sites_of_block(settings_.samples), sites_.size());
    std::vector<SiteSamples> samples(end - w.first);
    const int sets = std::min(most_sets_of_site, std::max(1, settings_.samples));
    for (int k = 0; k < sets; ++k)
      add_set(k, (settings_.samples + sets - 1) / sets, end, w, samples, counters);
    for (size_t i = 0; i < samples.size(); ++i) {
      if (settings_.are_texels) leave_out_cut_off(samples[i].all);
      out[w.first + i] = light_of(samples[i]);
    }
  }

 private:
  const PreparedScene& scene_;
  const Integrator& integrator_;
  const SiteList& sites_;
  const SiteSettings& settings_;
  const Box bounds_;

  void leave_out_cut_off(std::vector<Sample>& samples) const {
    if (samples.empty()) return;
    std::vector<LitPlace> places;
    for (const Sample& s : samples) places.push_back(s.place);
    const float offset = offset_of_point(places[0].position, bounds_);
    const std::vector<uint8_t> is_cut_off =
        cut_off_samples(scene_, places, offset, float(bounds_.diagonal()));
    size_t kept = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
      const bool counts =
          !is_cut_off[i] || !(settings_.is_all_light ||
                              is_enclosed(scene_, places[i], offset, float(bounds_.diagonal())));
      if (counts) samples[kept++] = samples[i];
    }
    samples.resize(kept);
  }

  void place_sensors(int set, int samples, size_t end, Worker& w,
                     std::vector<SiteSamples>& out) const {
    w.places.clear();
    w.sites.clear();
    w.sensors = {};
    for (size_t site = w.first; site < end; ++site) {
      w.pieces.take(sites_, site);
      if (w.pieces.is_empty()) continue;
      out[site - w.first].has_area = true;
      const uint64_t stream = hash_of(settings_.seed, stream::bake_sites, site, uint64_t(set));
      for (uint32_t i = 0; i < uint32_t(samples); ++i) {
        const SobolGroup random(stream, purpose_camera, i);
        w.places.push_back(w.pieces.place(random.get2(2).x, random.get2(0)));
        w.sites.push_back(uint32_t(site - w.first));
        const Place& p = w.places.back();
        w.sensors.positions.push_back(p.position);
        w.sensors.normals.push_back(p.normal);
        w.sensors.streams.push_back(stream);
        w.sensors.samples.push_back(i);
        w.sensors.offset = std::max(w.sensors.offset, offset_of_point(p.position, bounds_));
      }
    }
  }

  void add_set(int set, int samples, size_t end, Worker& w, std::vector<SiteSamples>& out,
               Counters& counters) const {
    place_sensors(set, samples, end, w, out);
    if (w.places.empty()) return;
    const std::vector<uint8_t> is_within =
        within_bodies(scene_, w.places, w.sensors.offset,
                      hash_of(settings_.seed, stream::bake_enclosure, w.first, uint64_t(set)));
    w.out.reset(w.places.size());
    const CheckContext context(&w, w.places.size(), name_of_sensor);
    integrator_.irradiance(w.sensors, *w.scratch, w.out, counters);
    for (size_t i = 0; i < w.places.size(); ++i) {
      Rgb e = w.out.direct[i] + w.out.indirect[i];
      if (!is_finite(e)) {
        e = Rgb{0};
        ++counters.nan_samples;
      }
      out[w.sites[i]].all.push_back(
          {{w.places[i].position, w.places[i].normal, luminance(e)}, e, set, is_within[i] != 0});
    }
  }
};

}  // namespace

std::vector<SiteLight> light_sites(const PreparedScene& scene, const Integrator& integrator,
                                   const SiteList& sites, const SiteSettings& settings,
                                   const ProgressCallback& progress, const StopFlag& stop,
                                   Counters& counters) {
  const Lighting lighting(scene, integrator, sites, settings);
  const size_t each = sites_of_block(settings.samples);
  const size_t blocks = (sites.size() + each - 1) / each;
  std::vector<SiteLight> out(sites.size());
  std::vector<Worker> workers(size_t(thread_count(settings.threads)));
  std::mutex mutex;
  size_t done = 0;
  parallel_for_slots(blocks, settings.threads, [&](size_t block, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) return;
    Worker& w = workers[slot];
    if (!w.scratch) w.scratch = integrator.make_scratch();
    Counters own;
    lighting.light(block, w, out, own);
    const std::lock_guard lock(mutex);
    counters += own;
    if (progress) progress(double(++done) / double(blocks));
  });
  if (stop.load(std::memory_order_relaxed)) out.clear();
  return out;
}

float share_of_fronts(const PreparedScene& scene, const SiteList& sites, size_t site,
                      uint64_t seed) {
  constexpr uint32_t rays = 64;
  Pieces pieces;
  pieces.take(sites, site);
  if (pieces.is_empty()) return 0;
  const Box box = bounds(scene.scene);
  int fronts = 0;
  for (uint32_t i = 0; i < rays; ++i) {
    const SobolGroup random(hash_of(seed, stream::bake_enclosure, site), purpose_camera, i);
    const SobolGroup direction(hash_of(seed, stream::bake_enclosure, site), purpose_scatter(0), i);
    const Place place = pieces.place(random.get2(2).x, random.get2(0));
    const Ray ray = look(place, offset_of_point(place.position, box), direction.get2(0));
    std::array<Hit, 1> hit;
    scene.tracer.closest({&ray, 1}, hit);
    fronts += seen_by(scene, ray, hit[0]) == Seen::front;
  }
  return float(fronts) / float(rays);
}

}  // namespace troffer
