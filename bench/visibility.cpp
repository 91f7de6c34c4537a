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
#include "generated_scenes.h"
#include "import/import.h"
#include "shadow/certified_cluster.h"
#include "shadow/certified_irradiance.h"
#include "visibility_parts.h"

using namespace troffer;
using namespace troffer::bench;

namespace {

// This thread's processor time: a busy machine does not spoil it.
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

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
  ShadowWorld world(b.scene, b.occluders, b.tracer);
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
      for (size_t i = 0; i < members.size(); ++i)
        receivers[i] = {tile.positions[members[i]], tile.normals[members[i]],
                        tile.normals[members[i]], tile.origins[members[i]],
                        stream_of(tile, members[i], 0, seed)};
      estimator.begin_cluster(receivers);
      answers.resize(members.size() * b.sources.size());
      const auto of_source = [&](size_t s) {
        return std::span(answers).subspan(s * members.size(), members.size());
      };
      for (size_t s = 0; s < b.sources.size(); ++s)
        estimator.evaluate(b.sources[s], {hash_of(s, 7u), 1, uint32_t(s), nullptr}, world, found[s],
                           of_source(s));
      for (const RayAnswer& r : estimator.end_cluster(world)) {
        SourceVisibility& a = of_source(r.tag)[r.member];
        run.rays += r.rays;
        a.visible += r.light / a.unoccluded;
        a.variance += r.light_variance / (a.unoccluded * a.unoccluded);
      }
      for (size_t s = 0; s < b.sources.size(); ++s)
        for (size_t i = 0; i < members.size(); ++i) {
          const SourceVisibility& a = of_source(s)[i];
          const size_t at = b.index(t, s, members[i]);
          ++run.answers[size_t(a.answer)];
          if (a.answer == ShadowAnswer::below) continue;
          out[at] = a.visible;
          if (b.reference[at] < 0) continue;
          const double e = double(a.visible) - double(b.reference[at]);
          run.error2[size_t(a.answer)] += e * e;
          run.predicted2[size_t(a.answer)] += double(a.variance);
        }
    }
  }
  run.seconds = now() - start;
  run.counters = estimator.counters();
  run.visited = world.visited_nodes();
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
  const Scene scene = file == "clutter"   ? clutter()
                      : file == "foliage" ? foliage()
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
    o.rays.pair_error = s.residual;
    o.rays.most_pair_rays = s.most_rays;
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
