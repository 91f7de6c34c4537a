#include "render/light_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "render/light_shapes.h"
#include "render/segment_walk.h"
#include "trace/surface.h"

namespace troffer {

namespace {

using Outline2 = std::vector<Vec2>;

// What of a convex polygon lies within the unit square (Sutherland & Hodgman 1974).
void clip_to_pixel(Outline2& polygon) {
  Outline2 in;
  for (const bool is_x : {true, false})
    for (const float sign : {1.0f, -1.0f}) {  // coordinate >= 0; <= 1
      const auto inside = [&](const Vec2& p) {
        const float c = is_x ? p.x : p.y;
        return sign > 0 ? c : 1 - c;
      };
      in.swap(polygon);
      polygon.clear();
      for (size_t i = 0; i < in.size(); ++i) {
        const Vec2 &a = in[i], &b = in[(i + 1) % in.size()];
        const float da = inside(a), db = inside(b);
        if (da >= 0) polygon.push_back(a);
        if ((da >= 0) != (db >= 0)) polygon.push_back(a + (b - a) * (da / (da - db)));
      }
    }
}

// Of a convex polygon; > 0 where it turns from x to y.
float area_of(std::span<const Vec2> p) {
  double twice = 0;
  for (size_t i = 2; i < p.size(); ++i) {
    const Vec2 a = p[i - 1] - p[0], b = p[i] - p[0];
    twice += double(a.x) * double(b.y) - double(a.y) * double(b.x);
  }
  return float(0.5 * twice);
}

// How far within a convex polygon of positive area a point lies; < 0: it does not.
float depth_in(std::span<const Vec2> polygon, const Vec2& p) {
  float least = std::numeric_limits<float>::infinity();
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2 side = polygon[i] - polygon[j], d = p - polygon[j];
    const float size = std::hypot(side.x, side.y);
    if (size > 0) least = std::min(least, (side.x * d.y - side.y * d.x) / size);
  }
  return least;
}

bool is_shining(const Scene& scene, const Ray& ray, const Hit& hit) {
  if (!hit.is_valid()) return false;
  const Surface s = surface_at(scene, ray, hit);
  return s.light >= 0 &&
         (scene.lights[size_t(s.light)].is_two_sided || dot(s.geometric_normal, ray.direction) < 0);
}

}  // namespace

// A point of an outline.
struct LightOutlines::Visit {
  uint32_t pixel = 0, light = 0;
  bool is_hidden = false;
};

// A light as the picture has it.
struct LightOutlines::Shapes {
  bool is_made = false, is_known = false;
  Rgb radiance;
  std::vector<Outline2> outlines;
  void make(const Scene& scene, const Light& light, const ViewingCamera& camera);
};

void LightOutlines::Shapes::make(const Scene& scene, const Light& light,
                                 const ViewingCamera& camera) {
  constexpr size_t most = 64;  // each is looked at for each pixel of its light's outline
  is_made = true;
  radiance = light.radiance;
  if (camera.has_lens() || !is_even(light) || light.triangles.size() > most) return;
  for (const LightLoop& loop : shining_loops(scene, light, camera)) {
    Outline2& out = outlines.emplace_back();
    for (const Vec3& p : loop)
      if (!camera.raster_of(p, out.emplace_back())) return;  // not all before the camera
  }
  is_known = true;
}

// Of places in the picture, relative to its size: rays that are so close to an outline may miss
// what they should meet.
static constexpr float rounding = 2e-6f;

LightOutlines::LightOutlines(const PreparedScene& scene, const ViewingCamera& camera,
                             const PixelRect& region, bool knows_covers)
    : region_(region),
      knows_covers_(knows_covers),
      blur_(rounding * float(camera.longer_side())),
      pixels_(size_t(region.width()) * size_t(region.height()), nothing) {
  // Where they run, and rays from the eye that end before them: what stands close before the light,
  // a fixture's rim, does not hide it here.
  constexpr float reach = 0.999f;
  std::vector<Visit> visits;
  std::vector<Ray> rays;
  const SegmentWalk walk(camera, region);
  std::vector<OutlineEdge> edges;
  const std::vector<Light>& lights = scene.scene.lights;
  for (size_t l = 0; l < lights.size(); ++l) {
    edges.clear();
    add_outline(scene.scene, lights[l], camera, edges);
    for (const OutlineEdge& e : edges)
      walk.walk(e.a, e.b, [&](const Vec3& position, const Vec2& r) {
        visits.push_back({uint32_t(index(int(r.x), int(r.y))), uint32_t(l)});
        rays.push_back(camera.ray(r, {0.5f, 0.5f}));
        const float distance = length(position - rays.back().origin);
        rays.back().t_max = std::min(reach * distance, distance - e.hidden_before);
      });
  }
  std::vector<uint8_t> is_hidden(rays.size());
  scene.tracer.occluded(rays, is_hidden, Coherence::coherent);
  for (size_t i = 0; i < visits.size(); ++i) visits[i].is_hidden = is_hidden[i] != 0;
  std::sort(visits.begin(), visits.end(), [](const Visit& a, const Visit& b) {
    return a.pixel != b.pixel ? a.pixel < b.pixel : a.light < b.light;
  });
  std::vector<Shapes> shapes(lights.size());
  for (size_t first = 0, end = 0; first < visits.size(); first = end) {
    while (end < visits.size() && visits[end].pixel == visits[first].pixel) ++end;
    take(scene, camera, std::span(visits).subspan(first, end - first), shapes);
  }
  check_covers(scene, camera);
}

// Of one pixel, sorted by lights.
void LightOutlines::take(const PreparedScene& scene, const ViewingCamera& camera,
                         std::span<const Visit> visits, std::vector<Shapes>& shapes) {
  uint32_t& pixel = pixels_[visits[0].pixel];
  const Pixel2 at{region_.x0 + int(visits[0].pixel % uint32_t(region_.width())),
                  region_.y0 + int(visits[0].pixel / uint32_t(region_.width()))};
  Cover cover;
  cover.first = uint32_t(pieces_.size());
  bool is_seen = false, is_known = knows_covers_;
  for (size_t first = 0, end = 0; first < visits.size(); first = end) {
    size_t hidden = 0;
    for (; end < visits.size() && visits[end].light == visits[first].light; ++end)
      hidden += visits[end].is_hidden ? 1 : 0;
    if (hidden == end - first) continue;
    is_seen = true;
    Shapes& of_light = shapes[visits[first].light];
    if (is_known && !of_light.is_made)
      of_light.make(scene.scene, scene.scene.lights[visits[first].light], camera);
    is_known = is_known && hidden == 0 && of_light.is_known;
    if (is_known) add_pieces(of_light, at, cover);
  }
  if (is_seen) pixel = is_known ? first_known + uint32_t(covers_.size()) : unknown;
  if (!is_seen || !is_known) return;
  cover.count = uint32_t(pieces_.size()) - cover.first;
  covers_.push_back(cover);
}

// Looks whether lamps are where they should be, at places that do not depend on any sample: what
// passes before them between the points of their outlines is found so, but what covers little.
void LightOutlines::check_covers(const PreparedScene& scene, const ViewingCamera& camera) {
  constexpr int across = 4;
  constexpr float clear = 1e-3f;  // pixels from the outline
  std::vector<uint8_t> is_wrong(pixels_.size(), 0);
  parallel_for(size_t(region_.height()), 0, [&](size_t row) {
    struct Look {
      size_t pixel;
      bool is_lamp;  // should be
    };
    std::vector<Look> looks;
    std::vector<Ray> rays;
    const int y = region_.y0 + int(row);
    for (int x = region_.x0; x < region_.x1; ++x) {
      if (!is_known(x, y)) continue;
      Random random(hash_of(uint64_t(x), uint64_t(y)));
      for (int k = 0; k < across * across; ++k) {
        const Vec2 jitter = random.next_vec2();
        const Vec2 place = (Vec2{float(k % across), float(k / across)} + jitter) * (1.0f / across);
        const float depth = depth_in_lamp(x, y, place);
        if (std::abs(depth) < clear) continue;
        looks.push_back({index(x, y), depth > 0});
        rays.push_back(camera.ray(Vec2{float(x), float(y)} + place, {0.5f, 0.5f}));
      }
    }
    std::vector<Hit> hits(rays.size());
    scene.tracer.closest(rays, hits, Coherence::coherent, Meeting::as_seen);
    for (size_t i = 0; i < looks.size(); ++i)
      if (is_shining(scene.scene, rays[i], hits[i]) != looks[i].is_lamp)
        is_wrong[looks[i].pixel] = 1;
  });
  for (size_t i = 0; i < pixels_.size(); ++i)
    if (is_wrong[i] != 0) pixels_[i] = unknown;
  is_doubtful_.assign(pixels_.size(), 0);
  const int width = region_.width(), height = region_.height();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (is_wrong[size_t(y) * size_t(width) + size_t(x)] != 0)
        for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
          for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
            is_doubtful_[size_t(v) * size_t(width) + size_t(u)] = 1;
}

// Pixels from the nearest border of a lamp's piece, > 0 within the one that the place is in.
float LightOutlines::depth_in_lamp(int x, int y, const Vec2& place) const {
  const Cover& cover = covers_[pixels_[index(x, y)] - first_known];
  float depth = -std::numeric_limits<float>::infinity();
  for (const Piece& piece : std::span(pieces_).subspan(cover.first, cover.count))
    depth = std::max(depth, depth_in(std::span(corners_).subspan(piece.first, piece.count), place));
  return depth;
}

void LightOutlines::add_pieces(const Shapes& shapes, const Pixel2& pixel, Cover& cover) {
  const Vec2 origin{float(pixel.x), float(pixel.y)};
  for (const Outline2& outline : shapes.outlines) {
    Outline2 part;
    for (const Vec2& p : outline) part.push_back(p - origin);
    clip_to_pixel(part);
    float area = area_of(part);
    if (area < 0) {
      std::reverse(part.begin(), part.end());
      area = -area;
    }
    if (!(area > 0)) continue;
    cover.mean += shapes.radiance * area;
    pieces_.push_back({shapes.radiance, uint32_t(corners_.size()), uint32_t(part.size())});
    corners_.insert(corners_.end(), part.begin(), part.end());
  }
}

Rgb LightOutlines::evened(int x, int y, const Vec2& place, Rgb seen) const {
  const uint32_t pixel = pixels_[index(x, y)];
  if (pixel < first_known) return {};
  const Cover& cover = covers_[pixel - first_known];
  Rgb sum = cover.mean;
  for (const Piece& piece : std::span(pieces_).subspan(cover.first, cover.count)) {
    const float depth = depth_in(std::span(corners_).subspan(piece.first, piece.count), place);
    const bool is_met =
        std::abs(depth) > blur_ ? depth > 0 : luminance(seen) > 0.5f * luminance(piece.radiance);
    if (is_met) sum = sum - piece.radiance;
  }
  return sum;
}

}  // namespace troffer
