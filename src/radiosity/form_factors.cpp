#include "radiosity/form_factors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "emitter/emitter_sample.h"
#include "emitter/irradiance.h"
#include "emitter/polygon.h"

namespace troffer {

namespace {

constexpr float far_in_piece_radii = 12;
constexpr int least_disc_points = 8;
constexpr size_t most_parts = 256;  // they are searched one by one
constexpr uint32_t purpose_visibility = 1;

void finish(Shooter& s) {
  double sum = 0;
  for (const LightPrimitive& p : s.pieces) s.area_sums.push_back(sum += double(p.area));
  s.is_exact = s.pieces.size() <= max_exact_pieces;
}

float largest_coordinate(const Box& b) {
  const Vec3 a = max(abs(b.lower), abs(b.upper));
  return std::max({a.x, a.y, a.z});
}

// Irradiance at x per unit radiance: the exact term, or the piece's middle for all of it where it
// is far and wholly above the horizon.
double piece_irradiance(const LightPrimitive& p, const Vec3& x, const Vec3& n) {
  if (p.vertex_count > 0) {
    const Vec3 d = p.centroid - x;
    const float along = dot(d, n), d2 = length_squared(d);
    if (along <= -p.radius) return 0;
    const float facing = -dot(d, Vec3(p.normal));
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

Vec3 point_on(const LightPrimitive& p, const Vec2& u) {
  if (p.shape == PrimitiveShape::sphere) return p.centroid + sphere_from_square(u) * p.radius;
  if (p.shape == PrimitiveShape::disk) {
    const Vec2 d = disk_from_square(u) * p.radius;
    return p.centroid + p.axis_x * d.x + Vec3(cross(p.normal, Vec3d(p.axis_x))) * d.y;
  }
  // fan about vertex 0; these are triangles and quadrilaterals, so a scan is short
  float x = u.x * p.area;
  for (uint32_t i = 1; i + 1 < p.vertex_count; ++i) {
    const Vec3 a = p.vertex(0), b = p.vertex(i), c = p.vertex(i + 1);
    const float area = 0.5f * length(cross(b - a, c - a));
    if (x < area || i + 2 == p.vertex_count) {
      const Vec2 w = triangle_from_square(Vec2{std::clamp(x / area, 0.0f, one_minus_epsilon), u.y});
      return a + (b - a) * w.x + (c - a) * w.y;
    }
    x -= area;
  }
  return p.centroid;
}

// Turns one number in [0, sums.back()) into an index, and what is left of it in [0,1).
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

// [1]: the shooter's area shrunk to discs of equal area at the rays' ends.
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

// Exact shooters: a piece by what it sends, a point of it by solid angle.
bool exact_end(const Shooter& s, const ElementPoint& r, Vec2 u, std::span<const double> sums,
               RayEnd& out) {
  double x = double(u.x) * sums.back();
  out.piece = choose(sums, x);
  const LightPrimitive& p = s.pieces[out.piece];
  EmitterSample sample_of;
  if (!sample(p, r.position, {float(x), u.y}, sample_of)) return false;
  const double sent = sums[out.piece] - (out.piece > 0 ? sums[out.piece - 1] : 0.0);
  const float cosine = dot(sample_of.wi, r.normal);
  if (!(cosine > 0) || !(sent > 0)) return false;
  out.point = sample_of.point;
  out.normal = sample_of.normal;
  // luminance × cosine / (p(piece) p(direction))
  out.weight = luminance(p.mean_radiance) * cosine / (float(sent) * sample_of.pdf_solid_angle);
  return std::isfinite(out.weight);
}

Ray ray_to(const Shooter& s, const ElementPoint& r, const RayEnd& end) {
  Vec3 target = end.point, normal = end.normal;
  if (s.round_radius > 0) {  // out to the sphere, on the side that shoots
    const Vec3 from_centre = normalize(target - s.round_centre);
    normal = dot(from_centre, normal) < 0 ? -from_centre : from_centre;
    target = s.round_centre + from_centre * s.round_radius;
  }
  target += normal * s.offset;
  Ray ray;
  ray.origin = r.position + r.normal * r.offset;
  ray.direction = target - ray.origin;
  ray.t_max = 1;
  return ray;
}

bool is_whole(const RayBudget& budget, float unoccluded) {
  return budget.whole_rays > 0 && unoccluded > budget.reference * budget.whole_from;
}

// Of the part whose middle is nearest.
float share_at(const Shooter& s, const Vec3& point) {
  float share = 1, nearest = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < s.parts.size(); ++i) {
    const float d = length_squared(s.parts[i].position - point);
    if (d >= nearest) continue;
    nearest = d;
    share = s.share[i];
  }
  return share;
}

int rays_wanted(const RayBudget& budget, float unoccluded) {
  const float share = unoccluded / (budget.reference * budget.tolerance);
  const float n = std::pow(std::max(0.5f * share, 0.0f), 4.0f / 3);
  const int wanted = n < float(budget.max_rays) ? std::max(1, int(std::ceil(n))) : budget.max_rays;
  return is_whole(budget, unoccluded) ? std::max(wanted, budget.whole_rays) : wanted;
}

void add_polygon(Shooter& s, const Vec3* corners, uint32_t count, Rgb radiance) {
  const Vec3d vector = area_vector({corners, count});
  LightPrimitive p;
  p.shape = count == 3 ? PrimitiveShape::triangle : PrimitiveShape::polygon;
  p.vertex_count = count;
  p.area = float(length(vector));
  if (!(p.area > 0)) return;
  p.normal = vector / length(vector);
  p.centroid = Vec3(centroid({corners, count}, p.normal));
  if (count <= 4)
    std::copy(corners, corners + count, p.vertices);
  else
    p.more_vertices = corners;  // the mesh's own, which stay
  for (uint32_t k = 0; k < count; ++k) {
    p.bounds.grow(corners[k]);
    p.radius = std::max(p.radius, length(corners[k] - p.centroid));
  }
  p.mean_radiance = radiance;
  s.pieces.push_back(p);
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
      const double e = piece_irradiance(p, r.position, r.normal);
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

  // The unoccluded irradiance and the visibility come from the same points, all of them at once.
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

  bool ray_end(uint32_t i, int k, int wanted, RayEnd& end) const {
    const ElementPoint& r = receiver(i);
    if (shooter_.is_exact)
      return exact_end(shooter_, r, random(i, k),
                       {s_.piece_irradiance.data() + i * pieces_, pieces_}, end);
    if (!disc_end(shooter_, r, random(i, k), wanted, end)) return false;
    end.weight *= luminance(shooter_.pieces[end.piece].mean_radiance);
    return true;
  }

  size_t trace_round() {
    s_.rays.clear();
    s_.weights.clear();
    s_.shares.clear();
    for (TransferScratch::Job& j : s_.jobs) {
      j.ray = s_.rays.size();
      for (int k = j.first; k < j.first + j.count; ++k) {
        RayEnd end;
        if (!ray_end(j.receiver, k, j.wanted, end) || !(end.weight > 0)) continue;
        s_.rays.push_back(ray_to(shooter_, receiver(j.receiver), end));
        s_.weights.push_back(end.weight);
        s_.shares.push_back(share_at(shooter_, end.point));
      }
    }
    s_.is_occluded.resize(s_.rays.size());
    tracer_.occluded(s_.rays, s_.is_occluded);
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
      if (s_.is_occluded[k] == 0) j.visible += sent;
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

Shooter emitter_shooter(const LightPrimitives& lights, uint32_t emitter) {
  Shooter s;
  const LightPrimitives::Range range = lights.of_emitter(emitter);
  for (uint32_t i = range.first; i < range.last; ++i) {
    s.pieces.push_back(lights[i]);
    s.offset = std::max(s.offset, 1.6e-5f * largest_coordinate(lights[i].bounds));
  }
  finish(s);
  return s;
}

Shooter patch_shooter(const RadiosityMesh& mesh, uint32_t patch, Rgb radiance) {
  Shooter s;
  const Patch& from = mesh.patches[patch];
  const Sheet& sheet = mesh.sheets[from.sheet];
  for (uint32_t i = sheet.first_piece; i < sheet.last_piece; ++i) {
    const auto [first, count] = mesh.pieces[i];
    const Vec3* c = mesh.piece_corners.data() + first;
    if (!from.is_back) {
      add_polygon(s, c, count, radiance);
    } else if (count <= 4) {
      const Vec3 reversed[4] = {c[count - 1], c[count - 2], c[count - 3], c[0]};
      add_polygon(s, reversed, count, radiance);
    } else {  // the reversed corners have no place to stay: a fan
      for (uint32_t k = 1; k + 1 < count; ++k) {
        const Vec3 triangle[3] = {c[0], c[k + 1], c[k]};
        add_polygon(s, triangle, 3, radiance);
      }
    }
  }
  s.round_centre = sheet.round_centre;
  s.round_radius = sheet.round_radius;
  s.offset = sheet.offset;
  finish(s);
  return s;
}

namespace {

// Of the shares over the shooter's area. The part whose middle is nearest need not be the one that
// a place belongs to, and what is sent must not be more than what is there.
double mean_share(const Shooter& s) {
  double sum = 0;
  for (const LightPrimitive& p : s.pieces) {
    const double part = double(p.area) / s.area_sums.back();
    const auto count = uint32_t(std::clamp(std::ceil(64 * part), 4.0, 64.0));
    double piece = 0;
    for (uint32_t k = 0; k < count; ++k)
      piece += double(share_at(s, point_on(p, SobolGroup(0, purpose_visibility, k).get2())));
    sum += part * piece / count;
  }
  return sum;
}

}  // namespace

void set_parts(Shooter& shooter, const RadiosityMesh& mesh, uint32_t patch,
               std::span<const float> luminances) {
  constexpr double unequal = 0.02;  // of the mean
  const Patch& p = mesh.patches[patch];
  const std::span<const ElementPoint> parts(mesh.points.data() + p.first_point, luminances.size());
  double sum = 0, area = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    sum += double(luminances[i]) * double(parts[i].area);
    area += double(parts[i].area);
  }
  if (!shooter.is_exact || parts.size() > most_parts || !(sum > 0)) return;
  const double mean = sum / area;
  bool is_equal = true;
  for (const float l : luminances)
    is_equal = is_equal && std::abs(double(l) - mean) < unequal * mean;
  if (is_equal) return;
  shooter.parts = parts;
  for (const float l : luminances) shooter.share.push_back(float(double(l) / mean));
  const double scale = mean_share(shooter);
  if (!(scale > 0)) shooter.share.clear();
  if (shooter.share.empty()) shooter.parts = {};
  for (float& share : shooter.share) share = float(double(share) / scale);
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
