#include "radiosity/solver.h"

#include <algorithm>
#include <cmath>

#include "radiosity/light_shots.h"
#include "radiosity/patch_shots.h"
#include "radiosity/point_lanes.h"
#include "radiosity/point_surfaces.h"
#include "radiosity/stored_lists.h"
#include "radiosity/unshot_power.h"

namespace troffer {

namespace {

constexpr double lights_progress = 0.2;  // share of the progress that is reserved for lights

// Initialises a solution, with mesh and options set, to its state before the first shot.
void begin(RadiositySolution& s, const LightPrimitives& primitives, const MeanSurface& mean) {
  const size_t points = s.mesh.points.size();
  s.general.assign(points, Rgb{0});
  s.general_direct.assign(points, Rgb{0});
  s.shot_radiance.assign(s.mesh.patches.size(), Rgb{0});
  s.stored.assign(points * s.stored_per_point, {});
  for (const LightPrimitive& p : primitives.all())
    if (p.has_surface()) s.balance.emitted += double(p.power);
  if (!(mean.area > 0)) return;
  s.mean_irradiance = float(std::min(s.balance.emitted / (mean.area * (1 - mean.diffuse)), 1e30));
}

// Runs a solution from start to end. Its members: the solution, the data that each step keeps from
// shot to shot, and the power to be shot.
class Solver {
 public:
  Solver(const Tracer& tracer, const LightPrimitives& primitives,
         const std::vector<PointSurface>& surfaces, RadiositySolution& solution, int threads,
         const StopFlag& stop)
      : s_(solution),
        stop_(stop),
        surfaces_(surfaces),
        light_shots_(tracer, primitives, solution, threads),
        patch_shots_(tracer, solution, threads),
        unshot_(solution.mesh, patch_shots_.receivers(), surfaces, solution.balance),
        lists_(solution, patch_shots_.receivers()),
        lanes_(patch_shots_.receivers(), surfaces) {
    for (std::vector<float>& g : general_) g.assign(patch_shots_.receivers().slots(), 0.0f);
    for (const Patch& p : s_.mesh.patches) is_closed_ = is_closed_ && p.open == 0;
  }

  void solve(const MeanSurface& mean, const RadiosityCallback& progress) {
    waiting_ = s_.balance.emitted;
    s_.end = RadiosityEnd::converged;
    if (s_.balance.emitted > 0 && mean.area > 0) {
      shoot_lights(progress);
      if (!stop_) shoot_patches(progress);
    }
    add_up_general();
    if (stop_ && !is_converged()) s_.end = RadiosityEnd::stopped;
    s_.is_complete = s_.end == RadiosityEnd::converged;
    s_.balance.unshot = unshot_.sum() + std::max(waiting_, 0.0);
    s_.ambient = unshot_.ambient(mean);
    s_.rays = rays();
  }

 private:
  double limit() const { return double(s_.options.unshot_fraction) * direct_; }
  bool is_converged() const { return waiting_ <= 0 && unshot_.sum() <= limit(); }
  uint64_t rays() const { return patch_shots_.rays() + light_shots_.rays(); }

  void shoot_lights(const RadiosityCallback& progress) {
    for (uint32_t e = 0; e < s_.light_count; ++e) {
      const LightShot shot = light_shots_.shoot(e, is_closed_, stop_);
      if (!shot.has_surface) continue;
      if (stop_) return;
      receive_light(e, shot);
      waiting_ -= shot.power;
      const double done = 1 - std::max(waiting_, 0.0) / s_.balance.emitted;
      report(progress, unshot_.sum(), lights_progress * done);
    }
    for (uint32_t b = 0; b < patch_shots_.receivers().blocks.size(); ++b) lists_.look_over(b);
    waiting_ = 0;  // remove rounding errors
    direct_ = s_.balance.absorbed + unshot_.sum();
  }

  void shoot_patches(const RadiosityCallback& progress) {
    const double first = unshot_.sum();
    for (double unshot = first; !stop_ && unshot > limit();) {
      if (s_.shots >= s_.options.max_shots) s_.end = RadiosityEnd::out_of_shots;
      if (rays() >= uint64_t(s_.options.max_million_rays) * 1'000'000)
        s_.end = RadiosityEnd::out_of_rays;
      if (s_.end != RadiosityEnd::converged || !shoot_brightest()) return;
      unshot = unshot_.sum();
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

  // Shoots the patch with the largest unshot power. Returns false if it was stopped.
  bool shoot_brightest() {
    const uint32_t brightest = unshot_.brightest_patch();
    const Patch& patch = s_.mesh.patches[brightest];
    const Rgb power = unshot_.of(brightest);
    Rgb radiance;
    if (!patch_shots_.shoot(brightest, power, unshot_.at_points_of(patch), lists_.least_in_block(),
                            stop_, radiance))
      return false;
    unshot_.clear(brightest, patch);
    receive_from_patch(s_.light_count + brightest, radiance, double(luminance(power)),
                       open_share(double(patch.open), patch.open_rays, is_closed_));
    return true;
  }

  // Stores a light's contributions to points, and passes on the power.
  void receive_light(uint32_t light, const LightShot& shot) {
    const std::span<const Transfer> transfers = light_shots_.transfers();
    powers_.resize(transfers.size());
    double sum = 0;
    for (size_t i = 0; i < transfers.size(); ++i) {
      const Transfer& t = transfers[i];
      powers_[i] = luminance(t.unoccluded) * t.visibility * surfaces_[i].area;
      sum += double(powers_[i]);
    }
    const Closure closure = close_shot(powers_, sum, shot.power, shot.open);
    for (uint32_t i = 0; i < transfers.size(); ++i) {
      const Transfer& t = transfers[i];
      if (t.unoccluded.is_black()) continue;
      lists_.add(i, {light, t.unoccluded * t.visibility, t.unoccluded});
      unshot_.pass_on(i, t.unoccluded * t.visibility, powers_[i], closure);
    }
    ++s_.shots;
    unshot_.count(shot.power, shot.open, closure);
  }

  // The same for a patch that sent `radiance`; patch_shots_ holds its transfers.
  void receive_from_patch(uint32_t source, const Rgb& radiance, double power,
                          const OpenShare& open) {
    const ShotReceived& shot = patch_shots_.received();
    const std::vector<ReceiverBlock>& blocks = patch_shots_.receivers().blocks;
    const float sent = luminance(radiance);
    if (!(sent > 0)) return;
    size_t slots = 0;
    for (const uint32_t b : shot.blocks) slots += slots_of(blocks[b]);
    powers_.resize(slots);
    double sum = 0;
    size_t at = 0;
    for (const uint32_t index : shot.blocks) {
      const ReceiverBlock& b = blocks[index];
      sum += double(block_powers(shot.received.data() + b.first_slot,
                                 lanes_.area.data() + b.first_slot, sent, slots_of(b),
                                 powers_.data() + at));
      at += slots_of(b);
    }
    const Closure closure = close_shot(powers_, sum, power, open);
    const BlockLight light{radiance / sent, float(closure.cap), float(closure.scale)};
    at = 0;
    for (const uint32_t index : shot.blocks) {
      const ReceiverBlock& b = blocks[index];
      keep_light(index, source, radiance, shot);
      unshot_.pass_on(b,
                      arrive(lanes_, b.first_slot, slots_of(b), powers_.data() + at, light,
                             unshot_.radiosity(b)),
                      light.tint);
      at += slots_of(b);
    }
    ++s_.shots;
    unshot_.count(power, open, closure);
  }

  // Adds the light to the lists of a block's points, or to their general values.
  void keep_light(uint32_t block, uint32_t source, const Rgb& radiance, const ShotReceived& shot) {
    const ReceiverBlock& b = patch_shots_.receivers().blocks[block];
    const float sent = luminance(radiance);
    const float* const received = shot.received.data() + b.first_slot;
    const float* const unoccluded = shot.unoccluded.data() + b.first_slot;
    float most = 0;
    for (uint32_t i = 0; i < b.count; ++i)
      most = std::max(most, std::max(received[i], hidden_importance * unoccluded[i]));
    if (!lists_.may_take(block, source, sent * most)) {
      float* const sums[3] = {general_[0].data() + b.first_slot, general_[1].data() + b.first_slot,
                              general_[2].data() + b.first_slot};
      add_irradiance(received, slots_of(b), radiance, sums);
      return;
    }
    for (uint32_t i = 0; i < b.count; ++i) {
      if (!(unoccluded[i] > 0)) continue;
      const float rank = sent * std::max(received[i], hidden_importance * unoccluded[i]);
      if (lists_.takes(b.first_slot + i, source, rank))
        lists_.add(b.first_point + i, {source, radiance * received[i], radiance * unoccluded[i]});
      else
        for (size_t c = 0; c < 3; ++c) general_[c][b.first_slot + i] += radiance[c] * received[i];
    }
    lists_.look_over(block);
  }

  void add_up_general() {
    for (const ReceiverBlock& b : patch_shots_.receivers().blocks)
      for (uint32_t i = 0; i < b.count; ++i)
        for (size_t c = 0; c < 3; ++c)
          s_.general[b.first_point + i][c] += general_[c][b.first_slot + i];
  }

  RadiositySolution& s_;
  const StopFlag& stop_;
  const std::vector<PointSurface>& surfaces_;
  LightShots light_shots_;
  PatchShots patch_shots_;
  UnshotPower unshot_;
  StoredLists lists_;
  PointLanes lanes_;
  std::array<std::vector<float>, 3> general_;  // general values from patches, by slot
  bool is_closed_ = true;                      // no ray left the scene
  double waiting_ = 0;                         // power of lights that have not shot yet
  double direct_ = 0;          // power that reached diffuse surfaces directly from lights
  std::vector<float> powers_;  // power that arrives by the current shot, before closure
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
  const std::vector<PointSurface> surfaces = point_surfaces(s.mesh);
  const MeanSurface mean = mean_surface(surfaces);
  begin(s, primitives, mean);
  Solver(tracer, primitives, surfaces, s, threads, stop).solve(mean, progress);
  return s;
}

}  // namespace troffer
