#include "radiosity/solver.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "radiosity/form_factors.h"

namespace troffer {

namespace {

constexpr size_t block_size = 128;

// By which contributions are ranked: what arrives, but a strong source that is hidden here counts
// for a quarter of what it would send, since its shadow's edge may be near.
float importance(const StoredContribution& c) {
  return std::max(luminance(c.received), 0.25f * luminance(c.unoccluded));
}

// What is not kept at a point.
struct General {
  Rgb& all;
  Rgb& direct;
  void add(Rgb received, bool is_light) const {
    all += received;
    if (is_light) direct += received;
  }
};

// Adds to the source's entry, to a free one, or instead of the least important one, which moves to
// the general value; into the general value if it is the least important itself. A source that
// shoots again after it was moved counts anew.
void keep(std::span<StoredContribution> list, const General& general, uint32_t light_count,
          const StoredContribution& c) {
  StoredContribution* least = nullptr;
  for (StoredContribution& entry : list) {
    if (entry.source == c.source) {
      entry.received += c.received;
      entry.unoccluded += c.unoccluded;
      return;
    }
    if (entry.source == no_source) {
      entry = c;
      return;
    }
    if (least == nullptr || importance(entry) < importance(*least)) least = &entry;
  }
  if (least == nullptr || importance(c) <= importance(*least)) {
    general.add(c.received, c.source < light_count);
    return;
  }
  general.add(least->received, least->source < light_count);
  *least = c;
}

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

class Solver {
 public:
  Solver(const Tracer& tracer, const LightPrimitives& primitives, RadiositySolution& solution,
         int threads)
      : tracer_(tracer),
        lights_(primitives),
        s_(solution),
        threads_(threads),
        scratch_(size_t(thread_count(threads))),
        transfers_(scratch_.size()) {
    const size_t points = s_.mesh.points.size(), patches = s_.mesh.patches.size();
    s_.general.assign(points, Rgb{0});
    s_.general_direct.assign(points, Rgb{0});
    s_.shot_radiance.assign(patches, Rgb{0});
    s_.stored.assign(points * s_.stored_per_point, {});
    unshot_.assign(patches, Rgb{0});
    unshot_at_.assign(points, 0);
    seen_.assign(points, 0);
    has_shot_.assign(patches, 0);
    received_.assign(points, Rgb{0});
    rays_.assign((points + block_size - 1) / block_size, 0);
    for (const LightPrimitive& p : primitives.all()) s_.balance.emitted += double(p.power);
    double diffuse = 0, all = 0;
    for (const ElementPoint& p : s_.mesh.points) {
      area_ += double(p.area);
      diffuse += double(p.area) * double(luminance(p.reflectance));
      all += double(p.area) * double(luminance(p.reflectance + p.specular_albedo));
    }
    if (!(area_ > 0)) return;
    constexpr double most = 0.98;  // of the light stays; a white room would stay bright for ever
    mean_albedo_ = std::min(all / area_, most);
    s_.mean_irradiance =
        float(s_.balance.emitted / (area_ * (1 - std::min(diffuse / area_, most))));
  }

  void solve(const RadiosityCallback& progress, const StopFlag& stop) {
    if (!(s_.balance.emitted > 0) || !(area_ > 0)) {
      s_.is_complete = true;
      return;
    }
    waiting_ = s_.balance.emitted;
    for (uint32_t e = 0; e < s_.light_count && !stop; ++e) {
      const Shooter shooter = light_shooter(lights_, e);
      if (shooter.pieces.empty()) continue;
      double power = 0;
      for (const LightPrimitive& p : shooter.pieces) power += double(p.power);
      shoot(shooter, e, power);
      waiting_ -= power;
      report(progress);
    }
    if (s_.shots > 0 && !stop) waiting_ = 0;  // but for rounding
    while (!stop) {
      const double limit = double(s_.options.unshot_fraction) * s_.balance.emitted;
      s_.is_complete = unshot_power() <= limit;
      if (s_.is_complete || s_.shots >= s_.options.max_shots) break;
      shoot_brightest();
      report(progress);
    }
    finish();
  }

 private:
  double unshot_power() const {
    double sum = 0;
    for (const Rgb& u : unshot_) sum += double(luminance(u));
    return sum;
  }

  void report(const RadiosityCallback& progress) const {
    if (progress) progress({s_.shots, (unshot_power() + waiting_) / s_.balance.emitted});
  }

  void shoot_brightest() {
    uint32_t brightest = 0;
    for (uint32_t i = 1; i < unshot_.size(); ++i)
      if (luminance(unshot_[i]) > luminance(unshot_[brightest])) brightest = i;
    const Rgb power = unshot_[brightest];
    unshot_[brightest] = Rgb{0};
    Shooter shooter = patch_shooter(s_.mesh, brightest, Rgb{1});
    if (!(shooter.area() > 0)) return;
    const Rgb radiance = power / (pi_f * shooter.area());
    for (LightPrimitive& p : shooter.pieces) p.mean_radiance = radiance;
    s_.shot_radiance[brightest] += radiance;
    const Patch& patch = s_.mesh.patches[brightest];
    const auto first = unshot_at_.begin() + patch.first_point;
    const auto last = unshot_at_.begin() + patch.last_point;
    set_parts(shooter, s_.mesh, brightest, {first, last});
    std::fill(first, last, 0.0f);
    shoot(shooter, s_.light_count + brightest, double(luminance(power)));
  }

  void shoot(const Shooter& shooter, uint32_t source, double power) {
    const std::vector<ElementPoint>& points = s_.mesh.points;
    const uint64_t stream = s_.is_light(source) ? light_stream(s_.options, source)
                                                : hash_of(s_.options.seed, source, s_.shots);
    const RayBudget budget = ray_budget(s_, source);
    const float luminance_sent = luminance(shooter.pieces[0].mean_radiance);
    const bool is_first = !s_.is_light(source) && has_shot_[s_.patch_of(source)] == 0;
    if (is_first) has_shot_[s_.patch_of(source)] = 1;
    parallel_for_slots(rays_.size(), threads_, [&](size_t block, size_t slot) {
      const size_t first = block * block_size;
      const size_t count = std::min(block_size, points.size() - first);
      std::vector<Transfer>& transfers = transfers_[slot];
      transfers.resize(count);
      rays_[block] += transfer(shooter, {points.data() + first, count}, tracer_, budget, stream,
                               first, transfers, scratch_[slot]);
      for (size_t i = 0; i < count; ++i) {
        const size_t point = first + i;
        received_[point] = transfers[i].unoccluded * transfers[i].visibility;
        if (transfers[i].unoccluded.is_black()) continue;
        if (!s_.is_light(source)) limit(point, transfers[i], luminance_sent, is_first);
        keep({s_.stored.data() + point * s_.stored_per_point, s_.stored_per_point},
             {s_.general[point], s_.general_direct[point]}, s_.light_count,
             {source, received_[point], transfers[i].unoccluded});
      }
    });
    ++s_.shots;
    s_.balance.shot += power;
    account();
  }

  // A point sees no more than a hemisphere. Where it does, as before surfaces of several meshes
  // that coincide or nearly do, patches give it so much less that light cannot grow from bounce to
  // bounce.
  void limit(size_t point, Transfer& t, float luminance_sent, bool is_first) {
    constexpr float most = 1.03f;  // an error of form factors is not cut
    if (is_first && t.share > 0)
      seen_[point] += luminance(t.unoccluded) / t.share * t.visibility / (pi_f * luminance_sent);
    if (seen_[point] <= most) return;
    t.unoccluded *= most / seen_[point];
    received_[point] = t.unoccluded * t.visibility;
  }

  // In the order of points, so that sums do not depend on threads.
  void account() {
    for (size_t i = 0; i < received_.size(); ++i) {
      const ElementPoint& p = s_.mesh.points[i];
      const Rgb power = received_[i] * p.area;
      if (power.is_black()) continue;
      const double all = double(luminance(power));
      const double diffuse = double(luminance(power * p.reflectance));
      const Rgb taken = power * p.specular_albedo;
      const double other = double(luminance(taken));
      lost_ += taken;
      arrived_ += all;
      s_.balance.lost_to_specular += other;
      s_.balance.absorbed += all - diffuse - other;
      unshot_[p.patch] += power * p.reflectance;
      unshot_at_[i] += luminance(received_[i] * p.reflectance);
    }
  }

  void finish() {
    s_.balance.escaped = s_.balance.shot - arrived_;
    s_.balance.unshot = unshot_power() + std::max(waiting_, 0.0);
    // [1] §3: what is unshot spreads over all surfaces, again and again. So does what mirrors,
    // glass and gloss took: they do not shoot, but their light is somewhere. Of both a part leaves
    // an open scene at every bounce, as it did of what was shot.
    Rgb sum = lost_;
    for (const Rgb& u : unshot_) sum += u;
    const double stays =
        s_.balance.shot > 0 ? std::clamp(arrived_ / s_.balance.shot, 0.0, 1.0) : 0.0;
    s_.ambient = sum * float(stays / (area_ * (1 - stays * mean_albedo_)));
    for (const uint64_t r : rays_) s_.rays += r;
  }

  const Tracer& tracer_;
  const LightPrimitives& lights_;
  RadiositySolution& s_;
  int threads_;
  double area_ = 0, arrived_ = 0;
  double mean_albedo_ = 0;        // diffuse and specular, by area
  Rgb lost_;                      // power that specular surfaces took
  double waiting_ = 0;            // power of lights that have not shot
  std::vector<Rgb> unshot_;       // power, per patch
  std::vector<float> unshot_at_;  // luminance of radiosity, per point
  std::vector<float> seen_;       // sum of form factors to patches that have shot, per point
  std::vector<uint8_t> has_shot_;
  std::vector<Rgb> received_;  // irradiance from the current shot, per point
  std::vector<uint64_t> rays_;
  std::vector<TransferScratch> scratch_;
  std::vector<std::vector<Transfer>> transfers_;
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
  Solver(tracer, primitives, s, threads).solve(progress, stop);
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
