#include "pairs.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "light/irradiance.h"
#include "render/camera.h"
#include "shadow_rays.h"
#include "trace/surface.h"

namespace troffer::bench {

DirectScene::DirectScene(std::string scene_name, Scene s)
    : name(std::move(scene_name)), prepared(std::move(s)), occluders(prepared.scene) {
  for (const LightPrimitive& p : prepared.primitives.all())
    for (const bool is_back : {false, true}) {
      FlatSource source;
      if (is_back && !p.is_two_sided) continue;
      if (!make_flat_source(p, is_back, source)) {
        ++left_out;
        continue;
      }
      sources.push_back(source);
      pieces.push_back(&p);
      radiance.push_back(double(luminance(p.mean_radiance)));
    }
  const Box box = bounds(prepared.scene);
  for (size_t a = 0; a < 3; ++a)
    magnitude =
        std::max({magnitude, double(std::abs(box.lower[a])), double(std::abs(box.upper[a]))});
  reach = 0.1f * box.diagonal();
}

namespace {

Tile tile_at(const DirectScene& s, const ViewingCamera& camera, const View& view, int tile) {
  const int across = view.width / 8;
  Tile out;
  for (int i = 0; i < 64 * view.spp; ++i) {
    const int row = i / view.spp / 8, step = i / view.spp % 8;
    const int px = tile % across * 8 + (row % 2 == 0 ? step : 7 - step),
              py = tile / across * 8 + row;
    const auto sample =
        uint32_t(py * view.width + px) * uint32_t(view.spp) + uint32_t(i % view.spp);
    Random random(hash_of(sample, 17u));
    const Vec2 jitter = random.next_vec2();
    const Ray ray = camera.ray({float(px) + jitter.x, float(py) + jitter.y}, {0.5f, 0.5f});
    Hit hit;
    s.prepared.tracer.closest({&ray, 1}, {&hit, 1});
    if (!hit.is_valid()) continue;
    const Surface at = surface_at(s.prepared.scene, ray, hit);
    const bool is_front = dot(at.geometric_normal, ray.direction) <= 0;
    const Vec3 n = is_front ? at.geometric_normal : -at.geometric_normal;
    out.positions.push_back(at.position);
    out.normals.push_back(n);
    out.origins.push_back(offset_origin(at, n));
    out.samples.push_back(sample);
    out.geometries.push_back(at.geometry);
    out.is_front.push_back(is_front ? 1 : 0);
  }
  return out;
}

double exact_unoccluded(const FlatSource& s, const Vec3& position, const Vec3& normal) {
  const Vec3d x(position), n(normal);
  if (s.is_disk) {
    const Vec3d centre = s.plane.origin + (s.plane.u + s.plane.v) * 0.5;
    return disk_irradiance(centre, s.plane.normal, 0.5 * length(s.plane.u), x, n);
  }
  // Lambert's formula needs the corners counterclockwise as seen from the emitting side.
  std::vector<Vec3d> corners = s.corners();
  const Vec3d turn = cross(corners[1] - corners[0], corners[2] - corners[1]);
  if (dot(turn, s.plane.normal) < 0) std::reverse(corners.begin(), corners.end());
  return polygon_irradiance(corners, x, n);
}

// True if the end that rays leave out, as a length along the source, is under a hundredth of the
// source. Otherwise the hit practically lies in the source's plane.
bool is_off_plane(const FlatSource& s, const Vec3& origin) {
  const double left_out = 1 - double(ray_length(s, origin));
  const double distance = length(s.plane.origin - Vec3d(origin));
  return left_out * distance < 0.01 * std::min(length(s.plane.u), length(s.plane.v));
}

// Marks the pairs that count: those whose unoccluded irradiance is at least a thousandth of the
// source's mean. If only a sliver of the source is above the horizon, few rays measure its visible
// share badly.
void find_counted(Pairs& p) {
  for (size_t s = 0; s < p.scene.sources.size(); ++s) {
    double sum = 0, count = 0;
    for (const bool is_second : {false, true})
      for (size_t t = 0; t < p.tiles.size(); ++t)
        for (size_t r = 0; r < p.tiles[t].size(); ++r) {
          const size_t i = p.index(t, s, r);
          if (!is_second) {
            const Tile& tile = p.tiles[t];
            p.unoccluded[i] =
                exact_unoccluded(p.scene.sources[s], tile.positions[r], tile.normals[r]);
            sum += p.unoccluded[i];
            count += p.unoccluded[i] > 0 ? 1 : 0;
          } else if (p.unoccluded[i] > 1e-3 * sum / count) {
            const bool is_off = is_off_plane(p.scene.sources[s], p.tiles[t].origins[r]);
            p.is_counted[i] = is_off ? 1 : 0;
            ++(is_off ? p.counted : p.in_plane);
          }
        }
    p.reachable += size_t(count);
  }
}

}  // namespace

Pairs::Pairs(const DirectScene& s, const View& view) : scene(s) {
  const ViewingCamera camera(s.prepared.scene.cameras.at(0), view.width, view.height);
  const int all = (view.width / 8) * (view.height / 8);
  size_t total = 0;
  for (int c = 0; c < view.tiles; ++c) {
    Random random(hash_of(uint64_t(c), 5u));
    const int t = int((double(c) + random.next_double()) / view.tiles * all);
    // successive tiles lie far apart
    tiles.push_back(tile_at(s, camera, view, int((int64_t(t) * 7919) % all)));
    first.push_back(total);
    hits += tiles.back().size();
    total += tiles.back().size() * s.sources.size();
  }
  unoccluded.assign(total, 0);
  is_counted.assign(total, 0);
  reference.assign(total, -1);
  find_counted(*this);
}

uint64_t stream_of(const Tile& tile, size_t receiver, size_t source, uint64_t seed) {
  return hash_of(uint64_t(tile.samples[receiver]), source, seed);
}

}  // namespace troffer::bench
