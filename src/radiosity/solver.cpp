#include "radiosity/solver.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "radiosity/closure.h"
#include "radiosity/form_factors.h"
#include "radiosity/patch_rows.h"
#include "radiosity/stored_list.h"

namespace troffer {

namespace {

constexpr uint32_t purpose_open = 3;
constexpr size_t most_row_bytes = 256u << 20;
// A patch's row serves all of its shots, which together send more than the first: rays are as many
// as if it sent so much more.
constexpr float expected_growth = 1.6f;
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

// Sample points that are dealt with together, and the rays that this took.
struct Chunk {
  uint32_t first = 0, last = 0;
  uint64_t rays = 0;
};

std::vector<Chunk> make_chunks(size_t points) {
  constexpr uint32_t size = 128;
  std::vector<Chunk> chunks;
  for (uint32_t first = 0; first < points; first += size)
    chunks.push_back({first, uint32_t(std::min<size_t>(points, first + size)), 0});
  return chunks;
}

// What of a point's light goes where.
struct PointSurface {
  float area = 0, per_area = 0;  // 0 where it is not finite
  uint32_t patch = 0;
  bool has_specular = false;
  Rgb reflectance, specular;
};

std::vector<PointSurface> surfaces_of(const RadiosityMesh& mesh) {
  std::vector<PointSurface> surfaces;
  surfaces.reserve(mesh.points.size());
  for (const ElementPoint& p : mesh.points) {
    PointSurface s;
    if (p.area < 1e30f) s.area = p.area;
    if (s.area > 1e-30f) s.per_area = 1 / s.area;
    s.patch = p.patch;
    for (size_t c = 0; c < 3; ++c) {
      s.reflectance[c] = std::clamp(p.reflectance[c], 0.0f, most_reflected);
      s.specular[c] = std::clamp(p.specular_albedo[c], 0.0f, most_reflected - s.reflectance[c]);
    }
    s.has_specular = !s.specular.is_black();
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
        chunks_(make_chunks(solution.mesh.points.size())),
        rows_(solution.mesh, tracer, threads, most_row_bytes),
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
    shot_.unoccluded.assign(points, 0);
    shot_.received.assign(points, 0);
    sources_.assign(s_.stored.size(), no_source);
    least_.assign(points, 0);
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
    double sums[4] = {};  // four at a time: the sum is asked for at every shot
    size_t i = 0;
    for (; i + 4 <= unshot_.size(); i += 4)
      for (size_t k = 0; k < 4; ++k) sums[k] += double(luminance(unshot_[i + k]));
    for (; i < unshot_.size(); ++i) sums[0] += double(luminance(unshot_[i]));
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }
  double limit() const { return double(s_.options.unshot_fraction) * direct_; }
  bool is_converged() const { return waiting_ <= 0 && unshot_power() <= limit(); }

  uint64_t rays() const {
    uint64_t sum = rows_.rays();
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
      find_light_transfers(shooter, e, stream);
      if (stop_) return;
      receive_light(e, power, open);
      waiting_ -= power;
      const double done = 1 - std::max(waiting_, 0.0) / s_.balance.emitted;
      report(progress, unshot_power(), lights_progress * done);
    }
    waiting_ = 0;  // but for rounding
    direct_ = s_.balance.absorbed + unshot_power();
  }

  void shoot_patches(const RadiosityCallback& progress) {
    const double first = unshot_power();
    for (double unshot = first; !stop_ && unshot > limit();) {
      if (s_.shots >= s_.options.max_shots) s_.end = RadiosityEnd::out_of_shots;
      if (rays() >= uint64_t(s_.options.max_million_rays) * 1'000'000)
        s_.end = RadiosityEnd::out_of_rays;
      if (s_.end != RadiosityEnd::converged || !shoot_brightest()) return;
      unshot = unshot_power();
      const double fallen = std::log(first / std::max(unshot, limit()));
      const double whole = std::log(first / limit());
      const double spent = double(s_.shots) / s_.options.max_shots;
      report(progress, unshot,
             std::max(lights_progress + (1 - lights_progress) * fallen / whole, spent));
    }
  }

  void report(const RadiosityCallback& progress, double unshot, double done) const {
    unshot += std::max(waiting_, 0.0);
    if (progress) progress({s_.shots, unshot / s_.balance.emitted, std::clamp(done, 0.0, 1.0)});
  }

  // False if there is nothing to shoot, or a stop came meanwhile.
  bool shoot_brightest() {
    uint32_t brightest = 0;
    float most = 0;
    for (uint32_t i = 0; i < unshot_.size(); ++i) {
      const float l = luminance(unshot_[i]);
      if (l <= most) continue;
      most = l;
      brightest = i;
    }
    const Rgb power = unshot_[brightest];
    Shooter shooter = patch_shooter(s_.mesh, brightest, Rgb{1});
    const Patch& patch = s_.mesh.patches[brightest];
    const auto first = unshot_at_.begin() + patch.first_point;
    const auto last = unshot_at_.begin() + patch.last_point;
    shot_.blocks.clear();  // and so it stays if it has no place to shoot from
    Rgb radiance;
    const uint32_t source = s_.light_count + brightest;
    if (shooter.area() > 0) {
      radiance = power / (pi_f * shooter.area());
      set_parts(shooter, s_.mesh, brightest, {first, last});
      const Rgb all = s_.shot_radiance[brightest] + radiance;
      if (!rows_.shoot(brightest, shooter, expected_growth * luminance(all), ray_budget(s_, source),
                       hash_of(s_.options.seed, source, s_.shots), stop_, has_shot_[brightest] == 0,
                       seen_, shot_))
        return false;
      s_.shot_radiance[brightest] = all;
      has_shot_[brightest] = 1;
    }
    unshot_[brightest] = Rgb{0};
    std::fill(first, last, 0.0f);
    receive_from_patch(source, radiance, double(luminance(power)),
                       open_share(double(patch.open), patch.open_rays, is_closed_));
    return true;
  }

  // transfers_ of all points.
  void find_light_transfers(const Shooter& shooter, uint32_t light, uint64_t stream) {
    const RayBudget budget = ray_budget(s_, light);
    parallel_for_slots(chunks_.size(), threads_, [&](size_t index, size_t slot) {
      if (stop_.load(std::memory_order_relaxed)) return;
      Chunk& c = chunks_[index];
      const std::span<Transfer> transfers(transfers_.data() + c.first, c.last - c.first);
      c.rays += transfer(shooter, {s_.mesh.points.data() + c.first, transfers.size()}, tracer_,
                         budget, stream, c.first, transfers, scratch_[slot]);
      for (Transfer& t : transfers)
        if (!is_finite(t.unoccluded)) t = {};
    });
  }

  // Stores what a light gave to points, and passes on its power.
  void receive_light(uint32_t light, double power, const OpenShare& open) {
    powers_.resize(transfers_.size());
    double sum = 0;
    for (size_t i = 0; i < transfers_.size(); ++i) {
      const Transfer& t = transfers_[i];
      powers_[i] = luminance(t.unoccluded) * t.visibility * surfaces_[i].area;
      sum += double(powers_[i]);
    }
    const Closure closure = close_shot(powers_, sum, power, open);
    for (uint32_t i = 0; i < transfers_.size(); ++i) {
      const Transfer& t = transfers_[i];
      if (t.unoccluded.is_black()) continue;
      store(i, {light, t.unoccluded * t.visibility, t.unoccluded});
      pass_on(i, t.unoccluded * t.visibility, powers_[i], closure);
    }
    count(power, open, closure);
  }

  // The same for a patch that sent `radiance`: shot_ says where to.
  void receive_from_patch(uint32_t source, const Rgb& radiance, double power,
                          const OpenShare& open) {
    powers_.clear();
    double sum = 0;
    const float sent = luminance(radiance);
    for_each_point([&](uint32_t i) {
      limit(i);
      powers_.push_back(shot_.received[i] * sent * surfaces_[i].area);
      sum += double(powers_.back());
    });
    const Closure closure = close_shot(powers_, sum, power, open);
    size_t at = 0;
    for_each_point([&](uint32_t i) {
      const float counted = powers_[at++];
      if (!(shot_.unoccluded[i] > 0)) return;
      const float important = sent * std::max(shot_.received[i], 0.25f * shot_.unoccluded[i]);
      const Rgb received = radiance * shot_.received[i];
      if (important > least_[i] || is_stored(i, source))
        store(i, {source, received, radiance * shot_.unoccluded[i]});
      else
        s_.general[i] += received;
      pass_on(i, received, counted, closure);
    });
    count(power, open, closure);
  }

  template <class Visit>
  void for_each_point(const Visit& visit) const {
    for (const uint32_t b : shot_.blocks) {
      const ReceiverBlock& block = rows_.blocks()[b];
      for (uint32_t i = 0; i < block.count; ++i) visit(block.first_point + i);
    }
  }

  // A point sees no more than a hemisphere. Where it does, as before surfaces of several meshes
  // that coincide or nearly do, patches give it so much less.
  void limit(uint32_t point) {
    constexpr float most = 1.03f;  // an error of form factors is not cut
    if (seen_[point] <= most) return;
    shot_.unoccluded[point] *= most / seen_[point];
    shot_.received[point] *= most / seen_[point];
  }

  bool is_stored(uint32_t point, uint32_t source) const {
    const uint32_t* sources = sources_.data() + size_t(point) * s_.stored_per_point;
    bool is_found = false;
    for (uint32_t k = 0; k < s_.stored_per_point; ++k) is_found |= sources[k] == source;
    return is_found;
  }

  // Into the point's list, and what a quick look at it needs.
  void store(uint32_t point, const StoredContribution& c) {
    const size_t first = size_t(point) * s_.stored_per_point;
    const std::span<StoredContribution> list(s_.stored.data() + first, s_.stored_per_point);
    keep(list, {s_.general[point], s_.general_direct[point]}, s_.light_count, c);
    float least = list.empty() ? std::numeric_limits<float>::infinity() : importance(list[0]);
    for (size_t k = 0; k < list.size(); ++k) {
      sources_[first + k] = list[k].source;
      least = std::min(least, list[k].source == no_source ? -1.0f : importance(list[k]));
    }
    least_[point] = least;
  }

  // power: of `received` over the point's element, luminance, before closure.
  void pass_on(uint32_t point, const Rgb& received, float power, const Closure& closure) {
    if (!(power > 0)) return;
    const PointSurface& surface = surfaces_[point];
    const float counted = closure.of(power);
    const Rgb arrived = received * (counted * surface.area / power);
    const Rgb reflected = arrived * surface.reflectance;
    const float passed = luminance(reflected);
    float rest = std::max(counted - passed, 0.0f);
    if (surface.has_specular) {
      const Rgb taken = arrived * surface.specular;
      s_.balance.lost_to_specular += double(luminance(taken));
      rest -= luminance(taken);
      lost_ += taken;
    }
    s_.balance.absorbed += double(rest);
    unshot_[surface.patch] += reflected;
    unshot_at_[point] += passed * surface.per_area;
  }

  void count(double power, const OpenShare& open, const Closure& closure) {
    EnergyBalance& b = s_.balance;
    ++s_.shots;
    b.shot += power;
    arrived_ += closure.arrived;
    const double missing = power - closure.arrived;
    const double escaped = std::clamp(missing, power * std::max(0.0, open.share - open.error),
                                      power * std::min(1.0, open.share + open.error));
    b.escaped += escaped;
    b.unaccounted += missing - escaped;
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
  std::vector<Transfer> transfers_;  // of the current light, per point
  ShotReceived shot_;                // of the current patch
  std::vector<float> powers_;        // what arrives by the current shot, before closure
  std::vector<uint32_t> sources_;    // of s_.stored
  std::vector<float> least_;         // per point: importance below which nothing new is stored
  std::vector<Chunk> chunks_;
  PatchRows rows_;
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
