#include "radiosity/solver.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "radiosity/closure.h"
#include "radiosity/form_factors.h"
#include "radiosity/stored_list.h"

namespace troffer {

namespace {

constexpr uint32_t purpose_open = 3;
// Of what arrives so much is absorbed at least: between perfect reflectors light would be shot for
// ever, and no surface reflects everything.
constexpr float most_reflected = 0.999f;

// A light shoots once, so that its transfers can be computed again.
uint64_t light_stream(const RadiosityOptions& options, uint32_t light) {
  return hash_of(options.seed, light);
}

RayBudget ray_budget(const RadiositySolution& s, uint32_t source) {
  RayBudget b;
  b.max_rays = std::max(1, s.options.max_rays);
  b.tolerance = std::max(1e-6f, s.options.tolerance);
  b.reference = s.mean_irradiance;
  if (s.is_light(source)) {
    b.whole_rays = s.options.light_rays;
    b.whole_from = s.options.light_share;
  }
  return b;
}

// What rays that start on the shooter as its light does find: the share of them that leaves.
OpenShare open_share_of(const Shooter& shooter, const Tracer& tracer, uint32_t rays_wanted,
                        uint64_t stream) {
  std::vector<double> sums;
  double sum = 0;
  for (const LightPrimitive& p : shooter.pieces) sums.push_back(sum += double(p.power));
  if (!(sum > 0)) return {};
  std::vector<Ray> rays;
  for (uint32_t k = 0; k < rays_wanted; ++k) {
    const SobolGroup group(stream, purpose_open, k);
    const Vec2 u = group.get2(), v = group.get2(2);
    const double x = (k + 0.5) / rays_wanted * sum;
    const auto i = std::min(size_t(std::upper_bound(sums.begin(), sums.end(), x) - sums.begin()),
                            sums.size() - 1);
    const LightPrimitive& p = shooter.pieces[i];
    const Vec3 at = point_on(p, u);
    Vec3 normal = Vec3(p.normal);
    if (p.shape == PrimitiveShape::sphere)
      normal = (at - p.centroid) * ((p.is_inside_out ? -1 : 1) / p.radius);
    if (p.is_two_sided && k % 2 == 1) normal = -normal;
    Ray r;
    r.origin = at + normal * shooter.offset;
    r.direction = Frame(normal).to_world(cosine_hemisphere_from_square(v));
    rays.push_back(r);
  }
  std::vector<Hit> hits(rays.size());
  tracer.closest(rays, hits);
  double leaving = 0;
  for (const Hit& h : hits) leaving += h.is_valid() ? 0 : 1;
  return open_share(leaving / rays_wanted, rays_wanted, leaving == 0);
}

// Whole patches, so that what their points receive is summed up by one thread.
struct Chunk {
  uint32_t first = 0, last = 0;  // points
  uint64_t rays = 0;
  double arrived = 0;                 // by the current shot: before closure …
  double absorbed = 0, specular = 0;  // … and after it
  Rgb taken;                          // by specular surfaces, after it
};

std::vector<Chunk> make_chunks(const RadiosityMesh& mesh) {
  constexpr uint32_t least_points = 512;
  std::vector<Chunk> chunks;
  for (const Patch& p : mesh.patches) {
    if (chunks.empty() || chunks.back().last - chunks.back().first >= least_points)
      chunks.push_back({p.first_point, p.first_point, 0, 0, 0, 0, {}});
    chunks.back().last = p.last_point;
  }
  return chunks;
}

// What of a point's light goes where.
struct PointSurface {
  float area = 0;  // 0 where it is not finite
  Rgb reflectance, specular;
};

std::vector<PointSurface> surfaces_of(const RadiosityMesh& mesh) {
  std::vector<PointSurface> surfaces;
  surfaces.reserve(mesh.points.size());
  for (const ElementPoint& p : mesh.points) {
    PointSurface s;
    if (p.area < 1e30f) s.area = p.area;
    for (size_t c = 0; c < 3; ++c) {
      s.reflectance[c] = std::clamp(p.reflectance[c], 0.0f, most_reflected);
      s.specular[c] = std::clamp(p.specular_albedo[c], 0.0f, most_reflected - s.reflectance[c]);
    }
    surfaces.push_back(s);
  }
  return surfaces;
}

// The state of a solution on its way: per patch and per point what waits to be shot.
class Solver {
 public:
  Solver(const Tracer& tracer, const LightPrimitives& primitives, RadiositySolution& solution,
         int threads, const StopFlag& stop)
      : tracer_(tracer),
        lights_(primitives),
        s_(solution),
        stop_(stop),
        threads_(threads),
        surfaces_(surfaces_of(solution.mesh)),
        chunks_(make_chunks(solution.mesh)),
        scratch_(size_t(thread_count(threads))) {
    const size_t points = s_.mesh.points.size(), patches = s_.mesh.patches.size();
    s_.general.assign(points, Rgb{0});
    s_.general_direct.assign(points, Rgb{0});
    s_.shot_radiance.assign(patches, Rgb{0});
    s_.stored.assign(points * s_.stored_per_point, {});
    unshot_.assign(patches, Rgb{0});
    unshot_at_.assign(points, 0);
    seen_.assign(points, 0);
    has_shot_.assign(patches, 0);
    transfers_.resize(points);
    powers_.assign(points, 0);
    for (const LightPrimitive& p : primitives.all())
      if (p.has_surface()) s_.balance.emitted += double(p.power);
    for (const Patch& p : s_.mesh.patches) is_closed_ = is_closed_ && p.open == 0;
    double diffuse = 0, all = 0;
    for (const PointSurface& p : surfaces_) {
      area_ += double(p.area);
      diffuse += double(p.area) * double(luminance(p.reflectance));
      all += double(p.area) * double(luminance(p.reflectance + p.specular));
    }
    if (!(area_ > 0)) return;
    constexpr double most = 0.98;  // of the light stays; a white room would stay bright for ever
    mean_albedo_ = std::min(all / area_, most);
    s_.mean_irradiance =
        float(std::min(s_.balance.emitted / (area_ * (1 - std::min(diffuse / area_, most))), 1e30));
  }

  void solve(const RadiosityCallback& progress) {
    waiting_ = s_.balance.emitted;
    s_.end = RadiosityEnd::converged;
    if (s_.balance.emitted > 0 && area_ > 0) {
      shoot_lights(progress);
      if (!stop_) shoot_patches(progress);
    }
    if (stop_ && !is_converged()) s_.end = RadiosityEnd::stopped;
    s_.is_complete = s_.end == RadiosityEnd::converged;
    finish();
  }

 private:
  double unshot_power() const {
    double sum = 0;
    for (const Rgb& u : unshot_) sum += double(luminance(u));
    return sum;
  }
  double limit() const { return double(s_.options.unshot_fraction) * direct_; }
  bool is_converged() const { return waiting_ <= 0 && unshot_power() <= limit(); }

  uint64_t rays() const {
    uint64_t sum = 0;
    for (const Chunk& c : chunks_) sum += c.rays;
    return sum;
  }

  void shoot_lights(const RadiosityCallback& progress) {
    constexpr uint32_t most_open_rays = 1 << 20;
    const uint32_t open_rays =
        std::clamp(most_open_rays / std::max(1u, s_.light_count), 64u, 4096u);
    for (uint32_t e = 0; e < s_.light_count; ++e) {
      const Shooter shooter = light_shooter(lights_, e);
      if (shooter.pieces.empty()) continue;
      double power = 0;
      for (const LightPrimitive& p : shooter.pieces) power += double(p.power);
      const uint64_t stream = light_stream(s_.options, e);
      OpenShare open = open_share_of(shooter, tracer_, open_rays, stream);
      if (is_closed_) open = {};
      find_transfers(shooter, e, stream, false);
      if (stop_) return;
      receive(e, power, open);
      waiting_ -= power;
      const double done = 1 - std::max(waiting_, 0.0) / s_.balance.emitted;
      report(progress, lights_progress * done);
    }
    waiting_ = 0;  // but for rounding
    direct_ = s_.balance.absorbed + unshot_power();
  }

  void shoot_patches(const RadiosityCallback& progress) {
    const double first = unshot_power();
    while (!stop_) {
      const double unshot = unshot_power();
      if (unshot <= limit()) return;
      if (s_.shots >= s_.options.max_shots) s_.end = RadiosityEnd::out_of_shots;
      if (rays() >= uint64_t(s_.options.max_million_rays) * 1'000'000)
        s_.end = RadiosityEnd::out_of_rays;
      if (s_.end != RadiosityEnd::converged || !shoot_brightest()) return;
      const double fallen = std::log(first / std::max(unshot_power(), limit()));
      const double whole = std::log(first / limit());
      const double spent = double(s_.shots) / s_.options.max_shots;
      report(progress, std::max(lights_progress + (1 - lights_progress) * fallen / whole, spent));
    }
  }

  void report(const RadiosityCallback& progress, double done) const {
    const double unshot = unshot_power() + std::max(waiting_, 0.0);
    if (progress) progress({s_.shots, unshot / s_.balance.emitted, std::clamp(done, 0.0, 1.0)});
  }

  // False if there is nothing to shoot, or a stop came meanwhile.
  bool shoot_brightest() {
    uint32_t brightest = 0;
    float most = 0;
    for (uint32_t i = 0; i < unshot_.size(); ++i)
      if (luminance(unshot_[i]) > most) most = luminance(unshot_[brightest = i]);
    const Rgb power = unshot_[brightest];
    Shooter shooter = patch_shooter(s_.mesh, brightest, Rgb{1});
    const Patch& patch = s_.mesh.patches[brightest];
    const auto first = unshot_at_.begin() + patch.first_point;
    const auto last = unshot_at_.begin() + patch.last_point;
    if (shooter.area() > 0) {
      const Rgb radiance = power / (pi_f * shooter.area());
      for (LightPrimitive& p : shooter.pieces) p.mean_radiance = radiance;
      set_parts(shooter, s_.mesh, brightest, {first, last});
      const uint32_t source = s_.light_count + brightest;
      find_transfers(shooter, source, hash_of(s_.options.seed, source, s_.shots),
                     has_shot_[brightest] == 0);
      if (stop_) return false;
      s_.shot_radiance[brightest] += radiance;
      has_shot_[brightest] = 1;
    } else {
      std::fill(transfers_.begin(), transfers_.end(), Transfer{});  // it has no place to shoot from
      std::fill(powers_.begin(), powers_.end(), 0.0f);
      for (Chunk& c : chunks_) c.arrived = 0;
    }
    unshot_[brightest] = Rgb{0};
    std::fill(first, last, 0.0f);
    receive(s_.light_count + brightest, double(luminance(power)),
            open_share(double(patch.open), patch.open_rays, is_closed_));
    return true;
  }

  // transfers_ and powers_ of all points.
  void find_transfers(const Shooter& shooter, uint32_t source, uint64_t stream, bool is_first) {
    const RayBudget budget = ray_budget(s_, source);
    const bool is_light = s_.is_light(source);
    const float luminance_sent = luminance(shooter.pieces[0].mean_radiance);
    parallel_for_slots(chunks_.size(), threads_, [&](size_t index, size_t slot) {
      if (stop_.load(std::memory_order_relaxed)) return;
      Chunk& c = chunks_[index];
      const std::span<Transfer> transfers(transfers_.data() + c.first, c.last - c.first);
      c.rays += transfer(shooter, {s_.mesh.points.data() + c.first, transfers.size()}, tracer_,
                         budget, stream, c.first, transfers, scratch_[slot]);
      c.arrived = 0;
      for (uint32_t i = c.first; i < c.last; ++i) {
        Transfer& t = transfers_[i];
        if (!is_finite(t.unoccluded)) t = {};
        if (!is_light) limit(i, t, luminance_sent, is_first);
        powers_[i] = luminance(t.unoccluded) * t.visibility * surfaces_[i].area;
        c.arrived += double(powers_[i]);
      }
    });
  }

  // A point sees no more than a hemisphere. Where it does, as before surfaces of several meshes
  // that coincide or nearly do, patches give it so much less.
  void limit(uint32_t point, Transfer& t, float luminance_sent, bool is_first) {
    constexpr float most = 1.03f;  // an error of form factors is not cut
    if (is_first && t.share > 0)
      seen_[point] += luminance(t.unoccluded) / t.share * t.visibility / (pi_f * luminance_sent);
    if (seen_[point] > most) t.unoccluded *= most / seen_[point];
  }

  // Stores what the current shot gave to points, and passes on its power.
  void receive(uint32_t source, double power, const OpenShare& open) {
    double sum = 0;
    for (const Chunk& c : chunks_) sum += c.arrived;
    const Closure closure = close_shot(powers_, sum, power, open);
    for (Chunk& c : chunks_) receive(source, closure, c);
    ++s_.shots;
    EnergyBalance& b = s_.balance;
    b.shot += power;
    for (const Chunk& c : chunks_) {  // in order: sums do not depend on threads
      b.absorbed += c.absorbed;
      b.lost_to_specular += c.specular;
      lost_ += c.taken;
    }
    arrived_ += closure.arrived;
    const double missing = power - closure.arrived;
    const double escaped = std::clamp(missing, power * std::max(0.0, open.share - open.error),
                                      power * std::min(1.0, open.share + open.error));
    b.escaped += escaped;
    b.unaccounted += missing - escaped;
  }

  void receive(uint32_t source, const Closure& closure, Chunk& c) {
    c.absorbed = c.specular = 0;
    c.taken = Rgb{0};
    for (uint32_t i = c.first; i < c.last; ++i) {
      const Transfer& t = transfers_[i];
      if (t.unoccluded.is_black()) continue;
      const Rgb received = t.unoccluded * t.visibility;
      keep({s_.stored.data() + size_t(i) * s_.stored_per_point, s_.stored_per_point},
           {s_.general[i], s_.general_direct[i]}, s_.light_count, {source, received, t.unoccluded});
      if (!(powers_[i] > 0)) continue;
      const float counted = closure.of(powers_[i]);
      const Rgb power = received * (surfaces_[i].area * (counted / powers_[i]));
      const Rgb reflected = power * surfaces_[i].reflectance;
      const Rgb taken = power * surfaces_[i].specular;
      c.specular += double(luminance(taken));
      c.taken += taken;
      c.absorbed += double(luminance(power - reflected - taken));
      unshot_[s_.mesh.points[i].patch] += reflected;
      unshot_at_[i] += luminance(reflected) / surfaces_[i].area;
    }
  }

  void finish() {
    s_.balance.unshot = unshot_power() + std::max(waiting_, 0.0);
    // [1] §3: what is unshot spreads over all surfaces, again and again. So does what mirrors,
    // glass and gloss took: they do not shoot, but their light is somewhere. Of both a part leaves
    // an open scene at every bounce, as it did of what was shot.
    Rgb sum = lost_;
    for (const Rgb& u : unshot_) sum += u;
    const double stays =
        s_.balance.shot > 0 ? std::clamp(arrived_ / s_.balance.shot, 0.0, 1.0) : 0.0;
    if (area_ > 0) s_.ambient = sum * float(stays / (area_ * (1 - stays * mean_albedo_)));
    s_.rays = rays();
  }

  static constexpr double lights_progress = 0.2;  // the lights' part of the way

  const Tracer& tracer_;
  const LightPrimitives& lights_;
  RadiositySolution& s_;
  const StopFlag& stop_;
  int threads_;
  std::vector<PointSurface> surfaces_;
  bool is_closed_ = true;  // no ray left the scene
  double area_ = 0, arrived_ = 0;
  double direct_ = 0;             // power that came to diffuse surfaces straight from lights
  double mean_albedo_ = 0;        // diffuse and specular, by area
  Rgb lost_;                      // power that specular surfaces took
  double waiting_ = 0;            // power of lights that have not shot
  std::vector<Rgb> unshot_;       // power, per patch
  std::vector<float> unshot_at_;  // luminance of radiosity, per point
  std::vector<float> seen_;       // sum of form factors to patches that have shot, per point
  std::vector<uint8_t> has_shot_;
  std::vector<Transfer> transfers_;  // of the current shot, per point
  std::vector<float> powers_;        // what arrives by it, before closure
  std::vector<Chunk> chunks_;
  std::vector<TransferScratch> scratch_;
};

}  // namespace

RadiositySolution solve_radiosity(const Scene& scene, const Tracer& tracer,
                                  const BsdfTables& tables, const LightPrimitives& primitives,
                                  const RadiosityOptions& options, int threads,
                                  const RadiosityCallback& progress, const StopFlag& stop) {
  RadiositySolution s;
  s.options = options;
  s.stored_per_point = std::min(options.stored_per_point, max_stored);
  s.light_count = uint32_t(scene.lights.size());
  s.mesh = mesh_for_radiosity(scene, tracer, tables, options.meshing, threads);
  Solver(tracer, primitives, s, threads, stop).solve(progress);
  return s;
}

Shooter whole_patch_shooter(const RadiositySolution& s, uint32_t patch) {
  Shooter shooter = patch_shooter(s.mesh, patch, s.shot_radiance[patch]);
  const Patch& p = s.mesh.patches[patch];
  std::vector<float> sent;
  for (uint32_t i = p.first_point; i < p.last_point; ++i)
    sent.push_back(luminance(s.mesh.points[i].reflectance * s.irradiance(i)));
  set_parts(shooter, s.mesh, patch, sent);
  return shooter;
}

void source_contributions(const Tracer& tracer, const LightPrimitives& primitives,
                          const RadiositySolution& s, uint32_t source,
                          std::span<const uint32_t> points, std::span<StoredContribution> out,
                          TransferScratch& scratch) {
  const bool is_light = s.is_light(source);
  const Shooter shooter =
      is_light ? light_shooter(primitives, source) : whole_patch_shooter(s, s.patch_of(source));
  scratch.transfers.assign(points.size(), {});
  if (!shooter.pieces.empty())
    transfer_to(
        shooter, s.mesh.points, points, tracer, ray_budget(s, source),
        is_light ? light_stream(s.options, source) : hash_of(s.options.seed, source, ~uint64_t(0)),
        scratch.transfers, scratch);
  for (size_t i = 0; i < points.size(); ++i) {
    const Transfer& t = scratch.transfers[i];
    out[i] = {source, t.unoccluded * t.visibility, t.unoccluded};
  }
}

}  // namespace troffer
