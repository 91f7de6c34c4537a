#include "reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "shadow_rays.h"

namespace troffer::bench {

namespace {

struct Facet {
  Vec3d a, b, c;
};

// Returns the triangles near the source, in front of its plane, that a ray may miss because it ends
// short of the plane. Triangles in the plane are not among them.
std::vector<Facet> rim_facets(const DirectScene& s, const FlatSource& source) {
  const Parallelogram& p = source.plane;
  const double in_plane = 2e-6 * s.magnitude, slab = 4e-6 * s.magnitude;
  const Vec3d side_u = normalize(p.u), side_v = cross(p.normal, side_u);
  const auto place = [&](const Vec3d& x) {
    return Vec3d{dot(x - p.origin, side_u), dot(x - p.origin, side_v), dot(x - p.origin, p.normal)};
  };
  Vec3d lower{0, 0, 0}, upper{0, 0, 0};
  for (const Vec3d& corner : {p.origin + p.u, p.origin + p.v, p.origin + p.u + p.v}) {
    const Vec3d q = place(corner);
    for (size_t a = 0; a < 2; ++a) {
      lower[a] = std::min(lower[a], q[a]);
      upper[a] = std::max(upper[a], q[a]);
    }
  }
  // over the last slab a ray moves along the plane by less than this, or its pair does not count
  const double margin = 0.02 * std::max(upper.x - lower.x, upper.y - lower.y);
  std::vector<Facet> facets;
  for (const Mesh& mesh : s.prepared.scene.meshes)
    for (const Triangle& t : mesh.triangles) {
      const Facet f{Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]),
                    Vec3d(mesh.positions[t[2]])};
      const Vec3d q[3] = {place(f.a), place(f.b), place(f.c)};
      const auto [low, high] = std::minmax({q[0].z, q[1].z, q[2].z});
      if (high <= in_plane || low > slab) continue;
      bool is_beside = false;
      for (size_t a = 0; a < 2; ++a) {
        const auto [from, to] = std::minmax({q[0][a], q[1][a], q[2][a]});
        is_beside = is_beside || to < lower[a] - margin || from > upper[a] + margin;
      }
      if (!is_beside) facets.push_back(f);
    }
  return facets;
}

// True if the segment from x to y crosses f. It uses signs of volumes, so that triangles with a
// common edge leave no crack.
bool crosses(const Facet& f, const Vec3d& x, const Vec3d& y) {
  const Vec3d d = y - x, a = f.a - x, b = f.b - x, c = f.c - x;
  const double u = dot(cross(c, b), d), v = dot(cross(a, c), d), w = dot(cross(b, a), d);
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double all = u + v + w;
  if (all == 0) return false;
  const Vec3d n = cross(f.b - f.a, f.c - f.a);
  const double along = dot(n, d), height = dot(n, a);
  const double t = height / along;
  return t > 0 && t < 1;
}

// Returns the visible share of one pair by `n` rays of the set `stream`.
float visible_share(const DirectScene& s, const FlatSource& source, const std::vector<Facet>& rim,
                    const HitPoint& hit, uint64_t stream, uint32_t n, ShadowRays& m) {
  constexpr uint32_t chunk = 1024;
  double all = 0, seen = 0;
  const Vec3d x(hit.origin);
  for (uint32_t first = 0; first < n; first += chunk) {
    m.clear();
    if (!add_shadow_rays(source, hit, stream, first, std::min(chunk, n - first), RayOrder::compact,
                         !rim.empty(), m))
      continue;
    m.is_hidden.resize(m.rays.size());
    s.prepared.tracer.occluded(m.rays, m.is_hidden, Coherence::coherent);
    for (size_t i = 0; i < m.rays.size(); ++i) {
      all += double(m.weights[i]);
      if (m.is_hidden[i] != 0 || m.weights[i] == 0) continue;
      bool is_hidden = false;
      if (!rim.empty()) {
        const Vec3d y = source.plane.origin + source.plane.u * double(m.points[i].x) +
                        source.plane.v * double(m.points[i].y);
        is_hidden =
            std::any_of(rim.begin(), rim.end(), [&](const Facet& f) { return crosses(f, x, y); });
      }
      if (!is_hidden) seen += double(m.weights[i]);
    }
  }
  return all > 0 ? float(seen / all) : 0.0f;
}

std::vector<float> cast(const Pairs& p, uint32_t rays, uint64_t seed) {
  std::vector<std::vector<Facet>> rims;
  for (const FlatSource& s : p.scene.sources) rims.push_back(rim_facets(p.scene, s));
  std::vector<float> values(p.size(), -1);
  // one row of a tile at a time keeps all cores busy to the end
  std::vector<std::pair<size_t, size_t>> work;
  for (size_t t = 0; t < p.tiles.size(); ++t)
    for (size_t r = 0; r < p.tiles[t].size(); r += 16) work.emplace_back(t, r);
  std::vector<ShadowRays> memory(size_t(thread_count(0)));
  parallel_for_slots(work.size(), 0, [&](size_t i, size_t slot) {
    const auto [t, begin] = work[i];
    const Tile& tile = p.tiles[t];
    for (size_t s = 0; s < p.scene.sources.size(); ++s)
      for (size_t r = begin; r < std::min(begin + 16, tile.size()); ++r) {
        const size_t at = p.index(t, s, r);
        if (p.is_counted[at] == 0) continue;
        const HitPoint hit{tile.positions[r], tile.normals[r], tile.origins[r]};
        values[at] = visible_share(p.scene, p.scene.sources[s], rims[s], hit,
                                   stream_of(tile, r, s, seed), rays, memory[slot]);
      }
  });
  return values;
}

uint64_t hash_bytes(uint64_t seed, const void* data, size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (; bytes >= 8; bytes -= 8, p += 8) {
    uint64_t word;
    std::memcpy(&word, p, 8);
    seed = hash_combine(seed, word);
  }
  for (; bytes > 0; --bytes) seed = hash_combine(seed, *p++);
  return seed;
}

template <class T>
uint64_t hash_array(uint64_t seed, const std::vector<T>& v) {
  return hash_bytes(hash_combine(seed, v.size()), v.data(), v.size() * sizeof(T));
}

// Returns a hash of everything that the reference depends on.
uint64_t key_of(const Pairs& p, uint32_t rays, uint64_t seed) {
  uint64_t h = hash_of(3, rays, seed);  // 3: version of this computation
  for (const Mesh& m : p.scene.prepared.scene.meshes)
    h = hash_array(hash_array(h, m.positions), m.triangles);
  for (const Disk& d : p.scene.prepared.scene.disks) {
    h = hash_bytes(h, &d.centre, sizeof d.centre);
    h = hash_bytes(h, &d.radius, sizeof d.radius);
  }
  for (const FlatSource& s : p.scene.sources) h = hash_bytes(h, &s.plane, sizeof s.plane);
  for (const Tile& t : p.tiles)
    h = hash_array(hash_array(hash_array(h, t.origins), t.normals), t.samples);
  return hash_array(h, p.is_counted);
}

bool read(const std::string& file, std::vector<float>& values) {
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
  return bool(in) && in.peek() == std::ifstream::traits_type::eof();
}

void write(const std::string& file, const std::vector<float>& values) {
  const std::string part = file + ".part";
  std::ofstream out(part, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            std::streamsize(values.size() * sizeof(float)));
  out.close();
  std::error_code failure;
  if (out) std::filesystem::rename(part, file, failure);
  if (!out || failure) throw EnvironmentError("cannot write " + file);
}

}  // namespace

Reference make_reference(Pairs& p, const ReferenceOptions& options) {
  Reference result;
  result.was_kept = true;
  std::vector<double> sum(p.size(), 0), sum2(p.size(), 0), means;
  std::vector<float> values(p.size());
  for (uint32_t k = 0; k < options.replicates; ++k) {
    const uint64_t seed = 1000 + k;
    const std::string file = fmt::format("{}/{}-{:016x}.reference", options.folder, p.scene.name,
                                         key_of(p, options.rays, seed));
    if (options.folder.empty() || !read(file, values)) {
      result.was_kept = false;
      values = cast(p, options.rays, seed);
      if (!options.folder.empty()) write(file, values);
    }
    double mean = 0;
    for (size_t i = 0; i < p.size(); ++i) {
      if (p.is_counted[i] == 0) continue;
      sum[i] += double(values[i]);
      sum2[i] += double(values[i]) * double(values[i]);
      mean += double(values[i]) / double(p.counted);
    }
    means.push_back(mean);
  }
  const auto n = double(options.replicates);
  double variance = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    if (p.is_counted[i] == 0) continue;
    p.reference[i] = float(sum[i] / n);
    variance += std::max(sum2[i] / n - (sum[i] / n) * (sum[i] / n), 0.0) / (n - 1);
  }
  result.rms_error = std::sqrt(variance / double(p.counted));
  double mean = 0, spread = 0;
  for (const double m : means) mean += m / n;
  for (const double m : means) spread += (m - mean) * (m - mean);
  result.mean_error = std::sqrt(spread / (n * (n - 1)));
  return result;
}

}  // namespace troffer::bench
