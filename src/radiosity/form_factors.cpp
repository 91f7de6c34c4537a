#include "radiosity/form_factors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "light/irradiance.h"
#include "light/light_sample.h"

namespace troffer {

namespace {

constexpr float far_in_piece_radii = 12;
constexpr float by_area_from_radii = 1.4f;
constexpr int least_disc_points = 8;
constexpr uint32_t purpose_visibility = 1;

// Returns the irradiance at x per unit radiance. Uses the exact term, or the piece's centroid if
// the piece is distant and wholly above the horizon. Surfaces nearer than `contact` give each other
// nothing: ray offsets exceed that distance, so that no ray could find an occluder between them.
double piece_irradiance(const LightPrimitive& p, const Vec3& x, const Vec3& n, float contact) {
  if (p.vertex_count > 0) {
    const Vec3 d = p.centroid - x;
    const float along = dot(d, n), d2 = length_squared(d);
    if (along <= -p.radius) return 0;
    const float facing = -dot(d, Vec3(p.normal));
    if (std::abs(facing) <= contact) return 0;
    if (facing <= 0 && !p.is_two_sided && d2 > sqr(p.radius)) {
      if (facing < -1e-4f * p.radius) return 0;
    }
    if (d2 > sqr(far_in_piece_radii * p.radius) && along > 2 * p.radius) {
      const float cosines = along * (p.is_two_sided ? std::abs(facing) : std::max(facing, 0.0f));
      return double(p.area * cosines) / (double(d2) * double(d2));
    }
  }
  return irradiance(p, Vec3d(x), Vec3d(n));
}

// Turns a number in [0, sums.back()) into an index, and x into the remainder in [0,1).
size_t choose(std::span<const double> sums, double& x) {
  const size_t i = std::min(size_t(std::upper_bound(sums.begin(), sums.end(), x) - sums.begin()),
                            sums.size() - 1);
  const double before = i > 0 ? sums[i - 1] : 0.0, width = sums[i] - before;
  x = width > 0 ? std::clamp((x - before) / width, 0.0, double(one_minus_epsilon)) : 0.0;
  return i;
}

struct RayEnd {
  Vec3 point, normal;  // the normal on the side towards the receiver
  float weight = 0;    // f / p, up to a factor common to all rays of the receiver
  size_t piece = 0;
};

// Disc approximation [1]: the shooter's area is shared by discs of equal area at the ray ends.
bool disc_end(const Shooter& s, const ElementPoint& r, Vec2 u, int count, RayEnd& out) {
  double x = double(u.x) * s.area_sums.back();
  out.piece = choose(s.area_sums, x);
  const LightPrimitive& p = s.pieces[out.piece];
  out.point = point_on(p, {float(x), u.y});
  out.normal = p.shape == PrimitiveShape::sphere
                   ? (out.point - p.centroid) * ((p.is_inside_out ? -1 : 1) / p.radius)
                   : Vec3(p.normal);
  const Vec3 d = out.point - r.position;
  const float d2 = length_squared(d);
  float facing = -dot(d, out.normal);
  if (p.is_two_sided && facing < 0) {
    facing = -facing;
    out.normal = -out.normal;
  }
  const float along = dot(d, r.normal);
  if (!(along > 0 && facing > 0 && d2 > 0)) return false;
  out.weight = along * facing * s.area() / (d2 * (d2 + s.area() / (pi_f * float(count))));
  return true;
}

// Samples a point of a flat piece by area. At this distance that is nearly by solid angle.
bool end_by_area(const LightPrimitive& p, const ElementPoint& r, Vec2 u, double sent, RayEnd& out) {
  out.point = point_on(p, u);
  out.normal = Vec3(p.normal);
  const Vec3 d = out.point - r.position;
  float facing = -dot(d, out.normal);
  if (p.is_two_sided && facing < 0) {
    facing = -facing;
    out.normal = -out.normal;
  }
  const float along = dot(d, r.normal), d2 = length_squared(d);
  if (!(along > 0 && facing > 0)) return false;
  out.weight = luminance(p.mean_radiance) * along * facing * p.area / (d2 * d2 * float(sent));
  return std::isfinite(out.weight);
}

// Samples a piece by the power that it sends and a point on it by solid angle, for exact shooters.
bool exact_end(const Shooter& s, const ElementPoint& r, Vec2 u, std::span<const double> sums,
               RayEnd& out) {
  double x = double(u.x) * sums.back();
  out.piece = choose(sums, x);
  const LightPrimitive& p = s.pieces[out.piece];
  const double sent = sums[out.piece] - (out.piece > 0 ? sums[out.piece - 1] : 0.0);
  if (!(sent > 0)) return false;
  if (p.vertex_count > 0 &&
      length_squared(p.centroid - r.position) > sqr(by_area_from_radii * p.radius))
    return end_by_area(p, r, {float(x), u.y}, sent, out);
  LightSample sample_of;
  if (!sample(p, r.position, {float(x), u.y}, sample_of)) return false;
  const float cosine = dot(sample_of.wi, r.normal);
  if (!(cosine > 0)) return false;
  out.point = sample_of.point;
  out.normal = sample_of.normal;
  // luminance × cosine / (p(piece) p(direction))
  out.weight = luminance(p.mean_radiance) * cosine / (float(sent) * sample_of.pdf_solid_angle);
  return std::isfinite(out.weight);
}

void aim(const Shooter& s, const ElementPoint& r, const RayEnd& end, Ray& ray) {
  Vec3 target = end.point, normal = end.normal;
  if (s.round_radius > 0) {  // project onto the sphere, on the side that shoots
    const Vec3 from_centre = normalize(target - s.round_centre);
    normal = dot(from_centre, normal) < 0 ? -from_centre : from_centre;
    target = s.round_centre + from_centre * s.round_radius;
  }
  target += normal * s.offset;
  ray.origin = r.position + r.normal * r.offset;
  ray.direction = target - ray.origin;
  ray.t_max = 1;
}

bool is_whole(const RayBudget& budget, float unoccluded) {
  return budget.whole_rays > 0 && unoccluded > budget.reference * budget.whole_from;
}

class Gatherer {
 public:
  Gatherer(const Shooter& shooter, std::span<const ElementPoint> receivers,
           std::span<const uint32_t> indices, const Tracer& tracer, const RayBudget& budget,
           uint64_t stream, size_t first_index, std::span<Transfer> transfers,
           TransferScratch& scratch)
      : shooter_(shooter),
        receivers_(receivers),
        indices_(indices),
        tracer_(tracer),
        budget_(budget),
        stream_(stream),
        first_index_(first_index),
        transfers_(transfers),
        s_(scratch),
        pieces_(shooter.is_exact ? shooter.pieces.size() : 0) {
    s_.piece_irradiance.assign(indices.size() * pieces_, 0);
  }

  size_t run() {
    s_.jobs.clear();
    for (uint32_t i = 0; i < indices_.size(); ++i) start(i);
    size_t rays = 0;
    while (!s_.jobs.empty()) rays += trace_round();
    return rays;
  }

 private:
  const ElementPoint& receiver(uint32_t i) const { return receivers_[indices_[i]]; }

  void start(uint32_t i) {
    transfers_[i] = {};
    const ElementPoint& r = receiver(i);
    if (!shooter_.is_exact) {
      start_disc(i, r);
      return;
    }
    double* sums = s_.piece_irradiance.data() + i * pieces_;
    double sum = 0;
    for (size_t k = 0; k < pieces_; ++k) {
      const LightPrimitive& p = shooter_.pieces[k];
      const double e = piece_irradiance(p, r.position, r.normal, shooter_.offset + r.offset);
      transfers_[i].unoccluded += p.mean_radiance * float(e);
      sums[k] = sum += e * double(luminance(p.mean_radiance));
    }
    begin_job(i, sum);
  }

  void begin_job(uint32_t i, double unoccluded) {
    if (!(unoccluded > 0)) return;
    add_job(i, rays_wanted(budget_, float(unoccluded)), float(unoccluded));
  }

  void add_job(uint32_t i, int wanted, float unoccluded) {
    const bool whole = is_whole(budget_, unoccluded);
    const int first = whole ? wanted : std::min(wanted, std::max(4, wanted / 4));
    s_.jobs.push_back({i, 0, first, wanted, whole, 0, 0, 0, 0});
  }

  // The unoccluded irradiance and the visibility use the same ray ends, all traced at once.
  void start_disc(uint32_t i, const ElementPoint& r) {
    int count = least_disc_points;
    for (int pass = 0; pass < 2; ++pass) {
      Rgb sum;
      for (int k = 0; k < count; ++k) {
        RayEnd end;
        if (disc_end(shooter_, r, random(i, k), count, end))
          sum += shooter_.pieces[end.piece].mean_radiance * end.weight;
      }
      transfers_[i].unoccluded = sum / float(count);
      const int wanted = rays_wanted(budget_, luminance(transfers_[i].unoccluded));
      if (pass == 1 || wanted <= count) break;
      count = wanted;
    }
    const float unoccluded = luminance(transfers_[i].unoccluded);
    if (unoccluded > 0) add_job(i, count, unoccluded);
  }

  Vec2 random(uint32_t i, int k) const {
    return SobolGroup(stream_ + mix64(first_index_ + indices_[i]), purpose_visibility, uint32_t(k))
        .get2();
  }

  // Computes the numbers of `random` for all rays of the jobs, in order.
  void draw_numbers() {
    s_.streams.clear();
    s_.samples.clear();
    for (const TransferScratch::Job& j : s_.jobs) {
      const uint64_t stream = stream_ + mix64(first_index_ + indices_[j.receiver]);
      for (int k = j.first; k < j.first + j.count; ++k) {
        s_.streams.push_back(stream);
        s_.samples.push_back(uint32_t(k));
      }
    }
    s_.numbers.resize(2 * s_.samples.size());
    sobol_groups(s_.streams.data(), s_.samples.data(), s_.samples.size(), purpose_visibility, 2,
                 s_.numbers.data());
  }

  bool ray_end(uint32_t i, const Vec2& u, int wanted, RayEnd& end) const {
    const ElementPoint& r = receiver(i);
    if (shooter_.is_exact)
      return exact_end(shooter_, r, u, {s_.piece_irradiance.data() + i * pieces_, pieces_}, end);
    if (!disc_end(shooter_, r, u, wanted, end)) return false;
    end.weight *= luminance(shooter_.pieces[end.piece].mean_radiance);
    return true;
  }

  size_t trace_round() {
    s_.rays.clear();
    s_.weights.clear();
    s_.shares.clear();
    s_.ends.clear();
    draw_numbers();
    const size_t numbers = s_.samples.size();
    size_t at = 0;
    for (TransferScratch::Job& j : s_.jobs) {
      j.ray = s_.rays.size();
      for (const size_t last = at + size_t(j.count); at < last; ++at) {
        RayEnd end;
        const Vec2 u{s_.numbers[at], s_.numbers[numbers + at]};
        if (!ray_end(j.receiver, u, j.wanted, end) || !(end.weight > 0)) continue;
        aim(shooter_, receiver(j.receiver), end, s_.rays.emplace_back());
        s_.weights.push_back(end.weight);
        s_.shares.push_back(share_at(shooter_, end.point));
        if (s_.records != nullptr) s_.ends.push_back(end.point);
      }
    }
    s_.is_occluded.resize(s_.rays.size());
    tracer_.occluded(s_.rays, s_.is_occluded, Coherence::coherent, s_.factors);
    s_.next_jobs.clear();
    for (size_t i = 0; i < s_.jobs.size(); ++i)
      weigh(s_.jobs[i], i + 1 < s_.jobs.size() ? s_.jobs[i + 1].ray : s_.rays.size());
    s_.jobs.swap(s_.next_jobs);
    return s_.rays.size();
  }

  static void set_share(Transfer& t, float share) {
    t.unoccluded *= share;
    t.share = share;
  }

  void weigh(TransferScratch::Job j, size_t last_ray) {
    for (size_t k = j.ray; k < last_ray; ++k) {
      const double weight = double(s_.weights[k]), sent = weight * double(s_.shares[k]);
      j.sum_without_shares += weight;
      j.sum += sent;
      if (s_.is_occluded[k] == 0) j.visible += sent * double(luminance(s_.factors[k]));
      if (s_.records != nullptr)
        s_.records->push_back({j.receiver, s_.ends[k], s_.weights[k], s_.is_occluded[k] == 0});
    }
    const float v = j.sum > 0 ? float(std::clamp(j.visible / j.sum, 0.0, 1.0)) : 0.0f;
    transfers_[j.receiver].visibility = v;
    const int done = j.first + j.count;
    const bool agree = !j.is_whole && j.sum > 0 && (j.visible == 0 || j.visible == j.sum);
    if (agree || done >= j.wanted) {
      if (!shooter_.share.empty() && j.sum_without_shares > 0)
        set_share(transfers_[j.receiver], float(j.sum / j.sum_without_shares));
      return;
    }
    j.first = done;
    j.count = j.wanted - done;
    s_.next_jobs.push_back(j);
  }

  const Shooter& shooter_;
  std::span<const ElementPoint> receivers_;
  std::span<const uint32_t> indices_;
  const Tracer& tracer_;
  const RayBudget& budget_;
  uint64_t stream_;
  size_t first_index_;
  std::span<Transfer> transfers_;
  TransferScratch& s_;
  size_t pieces_;
};

}  // namespace

int rays_wanted(const RayBudget& budget, float unoccluded) {
  const float share = 0.5f * unoccluded / (budget.reference * budget.tolerance);
  int wanted = 1;
  if (share > 1) {  // most transfers have less
    const float n = std::pow(share, 4.0f / 3);
    wanted = n < float(budget.max_rays) ? int(std::ceil(n)) : budget.max_rays;
  }
  return is_whole(budget, unoccluded) ? std::max(wanted, budget.whole_rays) : wanted;
}

size_t transfer(const Shooter& shooter, std::span<const ElementPoint> receivers,
                const Tracer& tracer, const RayBudget& budget, uint64_t stream, size_t first_index,
                std::span<Transfer> transfers, TransferScratch& scratch) {
  scratch.indices.resize(receivers.size());
  std::iota(scratch.indices.begin(), scratch.indices.end(), 0u);
  return Gatherer(shooter, receivers, scratch.indices, tracer, budget, stream, first_index,
                  transfers, scratch)
      .run();
}

size_t transfer_to(const Shooter& shooter, std::span<const ElementPoint> points,
                   std::span<const uint32_t> indices, const Tracer& tracer, const RayBudget& budget,
                   uint64_t stream, std::span<Transfer> transfers, TransferScratch& scratch) {
  return Gatherer(shooter, points, indices, tracer, budget, stream, 0, transfers, scratch).run();
}

}  // namespace troffer
