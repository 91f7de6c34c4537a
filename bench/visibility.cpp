// Visibility of flat sources at the hits of a camera: shadow rays against certified visibility.
//
//   bench_visibility [--tiles N] [--reference N] [--spp N] [--bias SEEDS]
//                    [--only NAME] [SCENE…]
//
// Hits of 8 × 8 pixels form tiles, of which N spread over the picture count. Per pair of hit and
// source that some light could reach: the root mean square error of the visible share of the
// unoccluded irradiance against N Owen-Sobol rays, nanoseconds on one thread (the faster of two
// runs), and rays. `fixed` casts N Owen-Sobol rays in packets of 16 and takes the ratio estimate.
// "clutter" and "foliage" as SCENE are generated (generated_scenes.h).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "base/warp.h"
#include "generated_scenes.h"
#include "import/import.h"
#include "render/camera.h"
#include "render/render.h"
#include "shadow/certified.h"
#include "shadow/certified_cluster.h"
#include "shadow/certified_irradiance.h"
#include "trace/occluders.h"
#include "trace/surface.h"
#include "trace/tracer.h"

using namespace troffer;

namespace {

// This thread's processor time: a busy machine does not spoil it.
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Facets from the hierarchy, rays from the tracer.
class World final : public ShadowScene {
 public:
  World(const Scene& scene, const Occluders& occluders, const Tracer& tracer)
      : occluders_(occluders), tracer_(tracer) {
    const Box b = bounds(scene);
    for (size_t a = 0; a < 3; ++a)
      magnitude_ =
          std::max({magnitude_, double(std::abs(b.lower[a])), double(std::abs(b.upper[a]))});
  }
  void candidates(std::span<const Plane> planes, const Box& receivers, const Box& source,
                  size_t most, ShadowCandidates& out) override {
    found_.facets.clear();
    found_.others = 0;
    found_.is_complete = true;
    found_.visited_nodes = 0;
    occluders_.gather(planes, most, found_);
    out.facets.clear();
    out.is_too_long = !found_.is_complete;
    out.is_complete = found_.is_complete && found_.others == 0;
    for (const uint32_t id : found_.facets) {
      const Occluders::Component& c = occluders_.component_of(id);
      const bool is_front_only =
          c.is_closed && is_apart(c.bounds, receivers) && is_apart(c.bounds, source);
      out.facets.push_back({occluders_.facet(id), id, is_front_only});
    }
    visited_ += found_.visited_nodes;
  }
  void trace(std::span<const ShadowSegment> segments, std::span<uint32_t> ids) override {
    rays_.resize(segments.size());
    hits_.resize(segments.size());
    for (size_t i = 0; i < segments.size(); ++i) {
      rays_[i].origin = segments[i].from;
      rays_[i].direction = segments[i].to - segments[i].from;
      rays_[i].t_min = 0;
      rays_[i].t_max = 1;
    }
    tracer_.closest(rays_, hits_, Coherence::coherent);
    for (size_t i = 0; i < segments.size(); ++i) {
      ids[i] = ray_is_free;
      if (!hits_[i].is_valid()) continue;
      const uint32_t id = occluders_.facet_of(hits_[i].geometry, hits_[i].primitive);
      ids[i] = id == no_facet ? ray_is_stopped : id;
    }
  }
  Quad facet(uint32_t id) const override { return occluders_.facet(id); }
  double magnitude() const override { return magnitude_; }
  uint64_t visited() const { return visited_; }

 private:
  static bool is_apart(const Box& a, const Box& b) {
    for (size_t axis = 0; axis < 3; ++axis)
      if (a.upper[axis] < b.lower[axis] || b.upper[axis] < a.lower[axis]) return true;
    return false;
  }
  const Occluders& occluders_;
  const Tracer& tracer_;
  double magnitude_ = 0;
  uint64_t visited_ = 0;
  Occluders::Found found_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

std::vector<FlatSource> flat_sources(const LightPrimitives& lights) {
  std::vector<FlatSource> sources;
  for (const LightPrimitive& p : lights.all())
    for (const bool is_back : {false, true}) {
      FlatSource source;
      if (is_back && !p.is_two_sided) continue;
      if (make_flat_source(p, is_back, source))
        sources.push_back(source);
      else
        fmt::print("  (a light that is not flat is left out)\n");
    }
  return sources;
}

struct Tile {
  std::vector<Vec3> positions, normals, origins;
  std::vector<uint32_t> pixels;
};

std::vector<Tile> hit_tiles(const Scene& scene, const Tracer& tracer, const Camera& camera,
                            int width, int height, int count, int spp) {
  const ViewingCamera view(camera, width, height);
  const int tx = width / 8, ty = height / 8;
  std::vector<Tile> tiles;
  Random random(5);
  for (int c = 0; c < count; ++c) {
    const int t = int((double(c) + random.next_double()) / count * tx * ty);
    // tiles are numbered so that successive ones lie far apart
    const int at = int((int64_t(t) * 7919) % (tx * ty));
    Tile tile;
    for (int i = 0; i < 64 * spp; ++i) {
      const int px = at % tx * 8 + i / spp % 8, py = at / tx * 8 + i / spp / 8;
      const Ray ray = view.ray({float(px) + random.next_float(), float(py) + random.next_float()},
                               {0.5f, 0.5f});
      Hit hit;
      tracer.closest({&ray, 1}, {&hit, 1});
      if (!hit.is_valid()) continue;
      const Surface s = surface_at(scene, ray, hit);
      const Vec3 n =
          dot(s.geometric_normal, ray.direction) > 0 ? -s.geometric_normal : s.geometric_normal;
      tile.positions.push_back(s.position);
      tile.normals.push_back(n);
      tile.origins.push_back(offset_origin(s, n));
      tile.pixels.push_back(uint32_t(py * width + px) * uint32_t(spp) + uint32_t(i % spp));
    }
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

// Rays end this share of the way to the source, clear of its plane.
float ray_length(const FlatSource& s, const Vec3& origin) {
  double m = 0;
  for (size_t a = 0; a < 3; ++a)
    m = std::max({m, std::abs(s.plane.origin[a]), double(std::abs(origin[a]))});
  const double height = dot(s.plane.normal, Vec3d(origin) - s.plane.origin);
  return float(std::max(1 - 2.5e-6 * m / height, 0.0));
}

// The visible share by n Owen-Sobol rays, ratio estimate; false where nothing can arrive.
struct FixedScratch {
  std::vector<Ray> rays;
  std::vector<float> weights, numbers;
  std::vector<uint8_t> hidden;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
};

// Moves a point of the unit square into the source's outline, keeping areas: along a fan of
// triangles, or onto the disk.
void onto_outline(const FlatSource& s, float& u, float& v) {
  if (s.is_disk) {
    const Vec2 p = disk_from_square(Vec2{u, v});
    u = 0.5f + 0.5f * p.x;
    v = 0.5f + 0.5f * p.y;
    return;
  }
  const std::vector<Vec2>& o = s.outline;
  if (o.empty()) return;
  float all = 0, passed = 0;
  const auto area = [&](size_t i) {
    const Vec2 e = o[i] - o[0], f = o[i + 1] - o[0];
    return std::abs(e.x * f.y - e.y * f.x);
  };
  for (size_t i = 1; i + 1 < o.size(); ++i) all += area(i);
  for (size_t i = 1; i + 1 < o.size(); ++i) {
    const float share = area(i) / all;
    if (u < passed + share || i + 2 == o.size()) {
      const float along = std::min((u - passed) / share, 1.0f), out = std::sqrt(v);
      const Vec2 p = o[0] + ((o[i] - o[0]) * (1 - along) + (o[i + 1] - o[0]) * along) * out;
      u = p.x;
      v = p.y;
      return;
    }
    passed += share;
  }
}

bool prepare_fixed(const FlatSource& s, const Vec3& position, const Vec3& normal,
                   const Vec3& origin, uint64_t stream, uint32_t n, FixedScratch& f) {
  const Vec3d x(position), nn(normal);
  if (!(dot(s.plane.normal, x - s.plane.origin) > 0)) return false;
  f.streams.assign(n, stream);
  f.samples.resize(n);
  for (uint32_t i = 0; i < n; ++i) f.samples[i] = i;
  f.numbers.resize(2 * n);
  sobol_groups(f.streams.data(), f.samples.data(), n, 0, 2, f.numbers.data());
  const Vec3 o = Vec3(s.plane.origin - x), u(s.plane.u), v(s.plane.v);
  const size_t before = f.weights.size();
  float sum = 0;
  const Vec3 shift = position - origin;
  const float length = ray_length(s, origin);
  for (uint32_t i = 0; i < n; ++i) {
    float a = f.numbers[i], b = f.numbers[n + i];
    onto_outline(s, a, b);
    const Vec3 d = o + u * a + v * b;
    const float cosine = dot(d, normal), square = dot(d, d);
    const float w = cosine > 0 ? cosine / (square * square) : 0;
    f.weights.push_back(w);
    sum += w;
    Ray r;
    r.origin = origin;
    r.direction = d + shift;
    r.t_max = w > 0 ? length : 0.0f;
    f.rays.push_back(r);
  }
  if (sum > 0) return true;
  f.weights.resize(before);
  f.rays.resize(before);
  return false;
}

struct Pair {
  uint32_t tile, receiver, source;
};

struct Bench {
  const Scene& scene;
  const Tracer& tracer;
  const Occluders& occluders;
  std::vector<FlatSource> sources;
  std::vector<Tile> tiles;
  std::vector<float> reference;      // per tile, source, receiver; -1: does not count
  std::vector<char> is_significant;  // enough light would arrive to count
  std::vector<size_t> first;         // per tile

  size_t index(size_t tile, size_t source, size_t receiver) const {
    return first[tile] + source * tiles[tile].positions.size() + receiver;
  }
};

uint64_t stream_of(const Tile& t, size_t receiver, size_t source, uint64_t seed) {
  return hash_of(uint64_t(t.pixels[receiver]), source, seed);
}

// Not where the end that a ray leaves out is longer than a hundredth of the source: rays would miss
// what stands at its rim.
bool can_rays_tell(const FlatSource& s, const Vec3& origin) {
  const double left_out = 1 - double(ray_length(s, origin));
  const double distance = length(s.plane.origin - Vec3d(origin));
  return left_out * distance < 0.01 * std::min(length(s.plane.u), length(s.plane.v));
}

// Pairs count where a source unhidden would give at least a thousandth of its mean irradiance:
// where only a sliver of it stands above the horizon, few rays would say nothing of how much is
// visible.
void find_significant(Bench& b) {
  std::vector<float> values;
  b.is_significant.assign(b.reference.size(), 0);
  for (size_t s = 0; s < b.sources.size(); ++s) {
    double sum = 0, count = 0;
    for (const bool is_second : {false, true})
      for (size_t t = 0; t < b.tiles.size(); ++t) {
        const Tile& tile = b.tiles[t];
        values.resize(tile.positions.size());
        ReceiverArrays arrays;
        arrays.assign(values.size());
        for (size_t r = 0; r < values.size(); ++r)
          arrays.set(r, tile.positions[r], tile.normals[r]);
        unoccluded_irradiance(b.sources[s].corners(), b.sources[s].plane.normal, arrays,
                              values.data());
        for (size_t r = 0; r < values.size(); ++r) {
          if (is_second)
            b.is_significant[b.index(t, s, r)] = double(values[r]) > 1e-3 * sum / count &&
                                                 can_rays_tell(b.sources[s], tile.origins[r]);
          else if (values[r] > 0) {
            sum += double(values[r]);
            ++count;
          }
        }
      }
  }
}

double fixed_run(const Bench& b, uint32_t n, uint64_t seed, std::vector<float>& out) {
  FixedScratch f;
  out.assign(b.reference.size(), -1);
  const double start = now();
  std::vector<size_t> where;
  const auto flush = [&] {
    f.hidden.resize(f.rays.size());
    b.tracer.occluded(f.rays, f.hidden, Coherence::coherent);
    for (size_t p = 0; p < where.size(); ++p) {
      float all = 0, seen = 0;
      for (size_t i = p * n; i < (p + 1) * n; ++i) {
        all += f.weights[i];
        seen += f.hidden[i] != 0 ? 0.0f : f.weights[i];
      }
      out[where[p]] = seen / all;
    }
    f.rays.clear();
    f.weights.clear();
    where.clear();
  };
  for (size_t t = 0; t < b.tiles.size(); ++t) {
    const Tile& tile = b.tiles[t];
    for (size_t s = 0; s < b.sources.size(); ++s)
      for (size_t r = 0; r < tile.positions.size(); ++r) {
        if (!prepare_fixed(b.sources[s], tile.positions[r], tile.normals[r], tile.origins[r],
                           stream_of(tile, r, s, seed), n, f))
          continue;
        where.push_back(b.index(t, s, r));
        if (f.rays.size() >= 8192) flush();
      }
  }
  flush();
  return now() - start;
}

struct CertifiedRun {
  double seconds = 0;
  uint64_t rays = 0;
  uint64_t answers[5] = {};
  double error2[5] = {}, predicted2[5] = {};
  CertifiedCounters counters;
  uint64_t visited = 0;
};

CertifiedRun certified_run(const Bench& b, const CertifiedOptions& options, uint64_t seed,
                           std::vector<float>& out) {
  CertifiedRun run;
  out.assign(b.reference.size(), -1);
  CertifiedEstimator estimator(options);
  World world(b.scene, b.occluders, b.tracer);
  ReceiverClusters clusters;
  std::vector<ShadowReceiver> receivers;
  std::vector<SourceVisibility> answers;
  const double start = now();
  for (size_t t = 0; t < b.tiles.size(); ++t) {
    const Tile& tile = b.tiles[t];
    cluster_receivers(tile.positions, tile.normals, 1.0f, clusters);
    std::vector<FoundFacets> found(b.sources.size());
    for (size_t c = 0; c < clusters.size(); ++c) {
      const auto members = clusters.members(c);
      receivers.resize(members.size());
      answers.resize(members.size());
      for (size_t i = 0; i < members.size(); ++i)
        receivers[i] = {tile.positions[members[i]], tile.normals[members[i]],
                        tile.normals[members[i]], tile.origins[members[i]],
                        stream_of(tile, members[i], 0, seed)};
      estimator.begin_cluster(receivers);
      for (size_t s = 0; s < b.sources.size(); ++s) {
        estimator.evaluate(b.sources[s], hash_of(s, 7u), world, found[s], answers);
        for (size_t i = 0; i < members.size(); ++i) {
          const size_t at = b.index(t, s, members[i]);
          const SourceVisibility& a = answers[i];
          ++run.answers[size_t(a.answer)];
          if (a.answer == ShadowAnswer::below) continue;
          run.rays += a.rays;
          out[at] = a.visible;
          if (b.reference[at] >= 0) {
            const double e = double(a.visible) - double(b.reference[at]);
            run.error2[size_t(a.answer)] += e * e;
            run.predicted2[size_t(a.answer)] += double(a.variance);
          }
        }
      }
    }
  }
  run.seconds = now() - start;
  run.counters = estimator.counters();
  run.visited = world.visited();
  return run;
}

struct Error {
  double rms = 0, mean = 0, worst = 0;
  size_t pairs = 0;
};

Error error_of(const Bench& b, const std::vector<float>& values) {
  Error e;
  for (size_t i = 0; i < values.size(); ++i) {
    if (b.reference[i] < 0) continue;
    const double d = double(std::max(values[i], 0.0f)) - double(b.reference[i]);
    e.rms += d * d;
    e.mean += d;
    e.worst = std::max(e.worst, std::abs(d));
    ++e.pairs;
  }
  e.rms = std::sqrt(e.rms / double(e.pairs));
  e.mean /= double(e.pairs);
  return e;
}

// Nanoseconds that fixed sampling takes to reach an error: straight lines between its runs, both
// scales logarithmic.
double fixed_time(const std::vector<std::pair<double, double>>& runs, double error) {
  size_t i = 1;
  while (i + 1 < runs.size() && runs[i].first > error) ++i;
  const auto& [e0, t0] = runs[i - 1];
  const auto& [e1, t1] = runs[i];
  const double slope = std::log(t1 / t0) / std::log(e1 / e0);
  return t1 * std::pow(error / e1, slope);
}

void print(const std::string& name, const Error& e, double seconds, double rays) {
  fmt::print("  {:<28} rms {:.5f}  mean {:+.5f}  worst {:.3f}  {:8.0f} ns  {:7.2f} rays\n", name,
             e.rms, e.mean, e.worst, seconds / double(e.pairs) * 1e9, rays);
}

struct Arguments {
  int tiles = 64, spp = 1;
  uint64_t seeds = 0;  // more than 0: the mean error over so many seeds
  uint32_t reference = 4096;
  std::string only;
};

void run(const std::string& file, const Arguments& arguments) {
  const std::string& only = arguments.only;
  const uint32_t reference_rays = arguments.reference;
  const Scene scene = file == "clutter"   ? bench::clutter()
                      : file == "foliage" ? bench::foliage()
                                          : import_scene(file);
  const Tracer tracer(scene);
  const double start = now();
  const Occluders occluders(scene);
  const LightPrimitives lights(scene);
  fmt::print("{}: {} triangles, {} facets in {:.3f} s\n", file, triangle_count(scene),
             occluders.facet_count(), now() - start);
  Bench b{scene, tracer, occluders, flat_sources(lights), {}, {}, {}, {}};
  b.tiles = hit_tiles(scene, tracer, scene.cameras.at(0), 256, 256, arguments.tiles, arguments.spp);
  size_t total = 0;
  for (const Tile& t : b.tiles) {
    b.first.push_back(total);
    total += t.positions.size() * b.sources.size();
  }
  b.reference.assign(total, -1);
  find_significant(b);
  // The reference, a tile at a time on all cores.
  parallel_for(b.tiles.size(), 0, [&](size_t t) {
    FixedScratch f;
    const Tile& tile = b.tiles[t];
    for (size_t s = 0; s < b.sources.size(); ++s)
      for (size_t r = 0; r < tile.positions.size(); ++r) {
        if (!b.is_significant[b.index(t, s, r)]) continue;
        f.rays.clear();
        f.weights.clear();
        if (!prepare_fixed(b.sources[s], tile.positions[r], tile.normals[r], tile.origins[r],
                           stream_of(tile, r, s, 99), reference_rays, f))
          continue;
        f.hidden.resize(f.rays.size());
        tracer.occluded(f.rays, f.hidden, Coherence::coherent);
        double all = 0, seen = 0;
        for (size_t i = 0; i < f.rays.size(); ++i) {
          all += double(f.weights[i]);
          seen += f.hidden[i] != 0 ? 0 : double(f.weights[i]);
        }
        b.reference[b.index(t, s, r)] = float(seen / all);
      }
  });
  size_t penumbra = 0, lit = 0, dark = 0;
  for (const float v : b.reference) {
    penumbra += v > 0 && v < 1;
    lit += v == 1;
    dark += v == 0;
  }
  const double pairs = double(lit + dark + penumbra);
  fmt::print("  {} sources, {} pairs: {:.1f} % lit, {:.1f} % dark, {:.1f} % penumbra\n",
             b.sources.size(), lit + dark + penumbra, 100 * double(lit) / pairs,
             100 * double(dark) / pairs, 100 * double(penumbra) / pairs);
  std::vector<float> values;
  std::vector<std::pair<double, double>> baseline;  // error, nanoseconds
  for (const uint32_t n : {16u, 64u, 256u, 1024u}) {
    if (!only.empty() && only != "fixed") continue;
    double seconds = fixed_run(b, n, 1, values);
    const Error e = error_of(b, values);
    if (n <= 64) seconds = std::min(seconds, fixed_run(b, n, 2, values));
    print(fmt::format("fixed {}", n), e, seconds, n);
    baseline.emplace_back(e.rms, seconds / double(e.pairs) * 1e9);
  }
  struct Setting {
    const char* name;
    MaskLattice lattice;
    size_t longest;
    float residual;
    uint32_t most_rays;
  };
  const Setting settings[] = {

      {"coarse, lists of 256", coarse_lattice, 256, 0.05f, 16},
      {"coarse, lists of 1024", coarse_lattice, 1024, 0.05f, 16},
      {"fine, lists of 256", fine_lattice, 256, 0.02f, 64},
      {"fine, lists of 1024", fine_lattice, 1024, 0.02f, 64},
  };
  for (const Setting& s : settings) {
    if (std::string(s.name).find(only) == std::string::npos) continue;
    CertifiedOptions o;
    o.lattice = s.lattice;
    o.longest_list = s.longest;
    o.residual_error = s.residual;
    o.most_rays = s.most_rays;
    if (arguments.seeds > 0) {
      double sum = 0, sum2 = 0;
      for (uint64_t seed = 0; seed < arguments.seeds; ++seed) {
        certified_run(b, o, seed + 100, values);
        const double mean = error_of(b, values).mean;
        sum += mean;
        sum2 += mean * mean;
      }
      const auto n = double(arguments.seeds);
      const double mean = sum / n, variance = std::max(sum2 / n - mean * mean, 0.0);
      fmt::print("  {:<28} mean error over {} seeds {:+.6f}, its standard error {:.6f}\n", s.name,
                 arguments.seeds, mean, std::sqrt(variance / (n - 1)));
      continue;
    }
    CertifiedRun first = certified_run(b, o, 1, values);
    const Error e = error_of(b, values);
    const CertifiedRun again = certified_run(b, o, 2, values);
    print(s.name, e, std::min(first.seconds, again.seconds), double(first.rays) / double(e.pairs));
    const double all = double(e.pairs);
    if (baseline.size() > 1) {
      const double time = std::min(first.seconds, again.seconds) / all * 1e9;
      fmt::print("      {:.1f} times as fast as fixed at this error",
                 fixed_time(baseline, e.rms) / time);
      if (e.rms <= 0.005)
        fmt::print("; {:.1f} times as fast as fixed at .005", fixed_time(baseline, 0.005) / time);
      fmt::print("\n");
    }
    const auto rms = [&](int a) {
      return first.answers[a] > 0 ? std::sqrt(first.error2[a] / double(first.answers[a])) : 0.0;
    };
    const auto said = [&](int a) {
      return first.answers[a] > 0 ? std::sqrt(first.predicted2[a] / double(first.answers[a])) : 0.0;
    };
    const CertifiedCounters& c = first.counters;
    fmt::print(
        "      lit {:.1f} %  dark {:.1f} %  masked {:.1f} % (rms {:.4f}, said {:.4f})  "
        "mixed {:.1f} % (rms {:.4f}, said {:.4f}); {:.1f} receivers, {:.0f} candidates, {:.0f} "
        "nodes a cluster, {:.0f} % too "
        "long; {:.1f} facets a mask\n",
        100 * double(first.answers[1]) / all, 100 * double(first.answers[2]) / all,
        100 * double(first.answers[3]) / all, rms(3), said(3), 100 * double(first.answers[4]) / all,
        rms(4), said(4), all / double(c.gathers), double(c.candidates) / double(c.gathers),
        double(first.visited) / double(c.gathers), 100 * double(c.incomplete) / double(c.gathers),
        double(c.mask_facets) / double(std::max<uint64_t>(c.masks, 1)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files;
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const bool has_value = i + 1 < argc;
    if (name == "--tiles" && has_value)
      arguments.tiles = std::stoi(argv[++i]);
    else if (name == "--reference" && has_value)
      arguments.reference = uint32_t(std::stoul(argv[++i]));
    else if (name == "--spp" && has_value)
      arguments.spp = std::stoi(argv[++i]);
    else if (name == "--bias" && has_value)
      arguments.seeds = std::stoull(argv[++i]);
    else if (name == "--only" && has_value)
      arguments.only = argv[++i];
    else
      files.push_back(name);
  }
  if (files.empty())
    files = {TROFFER_SOURCE_DIR "/scenes/kj92room/kj92room.gltf",
             TROFFER_SOURCE_DIR "/scenes/modern-hall/modern-hall-diffuse.pbrt", "clutter",
             "foliage"};
  try {
    for (const std::string& f : files) run(f, arguments);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
