#include "render/light_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "base/streams.h"
#include "render/light_shapes.h"
#include "render/segment_walk.h"
#include "trace/surface.h"

namespace troffer {

namespace {

using Corner = LightOutlines::Corner;

// Clips a convex polygon to the unit square (Sutherland & Hodgman 1974). New sides along the square
// are not part of the outline.
void clip_to_pixel(std::vector<Corner>& polygon) {
  std::vector<Corner> in;
  for (double Vec2d::*const axis : {&Vec2d::x, &Vec2d::y})
    for (const double border : {0.0, 1.0}) {
      const auto inside = [&](const Corner& c) {
        return border == 0 ? c.at.*axis : border - c.at.*axis;
      };
      const auto at_border = [&](const Corner& a, const Corner& b, bool is_outline) {
        const double da = inside(a), db = inside(b);
        Corner c{a.at + (b.at - a.at) * (da / (da - db)), is_outline};
        c.at.*axis = border;
        return c;
      };
      in.swap(polygon);
      polygon.clear();
      for (size_t i = 0; i < in.size(); ++i) {
        const Corner &a = in[i], &b = in[(i + 1) % in.size()];
        const bool is_in = inside(a) >= 0, comes_in = inside(b) >= 0;
        if (is_in) polygon.push_back(a);
        if (is_in && !comes_in) polygon.push_back(at_border(a, b, false));
        if (!is_in && comes_in) polygon.push_back(at_border(a, b, a.is_outline));
      }
    }
}

// Returns the signed area of a convex polygon; positive if it turns from x to y.
double area_of(std::span<const Corner> p) {
  double twice = 0;
  for (size_t i = 2; i < p.size(); ++i) {
    const Vec2d a = p[i - 1].at - p[0].at, b = p[i].at - p[0].at;
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

// Signed distances of a point to the sides of a convex polygon of positive area, in pixels.
struct Depth {
  // to the nearest side; < 0 outside of the polygon
  double depth = std::numeric_limits<double>::infinity();
  double outline = std::numeric_limits<double>::infinity();  // to the nearest side of the outline
};
Depth depth_in(std::span<const Corner> polygon, const Vec2d& p) {
  Depth d;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Vec2d side = b.at - a.at, to = p - a.at;
    const double size = std::hypot(side.x, side.y);
    if (!(size > 0)) continue;
    const double depth = (side.x * to.y - side.y * to.x) / size;
    d.depth = std::min(d.depth, depth);
    if (a.is_outline && std::abs(depth) < std::abs(d.outline)) d.outline = depth;
  }
  return d;
}

// Reverses a polygon of negative area.
void turn(std::vector<Corner>& piece) {
  if (!(area_of(piece) < 0)) return;
  // A corner describes the side after it; after reversal that side comes before it.
  const size_t n = piece.size();
  std::vector<Corner> turned;
  for (size_t i = 0; i < n; ++i)
    turned.push_back({piece[n - 1 - i].at, piece[(2 * n - 2 - i) % n].is_outline});
  piece = std::move(turned);
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

// A light projected to the picture.
struct LightOutlines::Shapes {
  bool is_made = false, is_known = false;
  Rgb radiance;
  std::vector<std::vector<Corner>> pieces;  // polygons of positive area
  void make(const Scene& scene, const Light& light, const ViewingCamera& camera);
};

void LightOutlines::Shapes::make(const Scene& scene, const Light& light,
                                 const ViewingCamera& camera) {
  constexpr size_t most = 64;  // limit on cost: each pixel of the outline tests every piece
  is_made = true;
  radiance = light.radiance;
  if (camera.has_lens() || !is_even(light) || light.triangles.size() > most) return;
  for (const LightLoop& loop : shining_loops(scene, light, camera)) {
    std::vector<Corner> piece;
    for (const LightCorner& c : loop) {
      Vec2 at;
      if (!camera.raster_of(c.position, at)) return;  // partly behind the camera
      piece.push_back({Vec2d(at), c.is_outline});
    }
    turn(piece);
    pieces.push_back(std::move(piece));
  }
  is_known = true;
}

// Rounding error of positions in the picture, relative to its size. Rays this close to an outline
// may hit or miss arbitrarily.
static constexpr double rounding = 2e-6;

LightOutlines::LightOutlines(const PreparedScene& scene, const ViewingCamera& camera,
                             const PixelRect& region, bool knows_covers, int threads)
    : region_(region),
      knows_covers_(knows_covers),
      blur_(rounding * camera.longer_side()),
      pixels_(size_t(region.width()) * size_t(region.height()), nothing) {
  // Walks along the outlines and traces a ray from the eye to each point. Rays end just before the
  // light, so that objects close to it, such as a fixture's rim, do not count as hiding it.
  constexpr float reach = 0.999f;
  constexpr size_t most_rays = size_t(1) << 16;  // traced together
  std::vector<Visit> visits;
  std::vector<Ray> rays;
  std::vector<uint8_t> is_hidden;
  const auto trace = [&] {
    is_hidden.assign(rays.size(), 0);
    // Single rays: in a packet, the hit of a ray along an edge may depend on the other rays.
    scene.tracer.occluded(rays, is_hidden, Coherence::none);
    for (size_t i = 0; i < rays.size(); ++i)
      visits[visits.size() - rays.size() + i].is_hidden = is_hidden[i] != 0;
    rays.clear();
  };
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
    if (rays.size() > most_rays) trace();
  }
  trace();
  std::sort(visits.begin(), visits.end(), [](const Visit& a, const Visit& b) {
    return a.pixel != b.pixel ? a.pixel < b.pixel : a.light < b.light;
  });
  std::vector<Shapes> shapes(lights.size());
  for (size_t first = 0, end = 0; first < visits.size(); first = end) {
    while (end < visits.size() && visits[end].pixel == visits[first].pixel) ++end;
    take(scene, camera, std::span(visits).subspan(first, end - first), shapes);
  }
  check_covers(scene, camera, threads);
}

// Evaluates the visits of one pixel, which are sorted by light.
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
  cover.count = uint32_t(pieces_.size()) - cover.first;
  size_t corners = 0;
  for (uint32_t i = cover.first; i < pieces_.size(); ++i) corners += pieces_[i].count;
  is_known = is_known && corners <= most_corners;
  if (is_seen) pixel = is_known ? first_known + uint32_t(covers_.size()) : unknown;
  if (is_seen && is_known) {
    covers_.push_back(cover);
  } else if (cover.first < pieces_.size()) {
    corners_.resize(pieces_[cover.first].first);
    pieces_.resize(cover.first);
  }
}

// Tests whether lamps are visible where their outlines say, at places that are independent of all
// samples. This finds occluders between the visited outline points, except for small ones.
void LightOutlines::check_covers(const PreparedScene& scene, const ViewingCamera& camera,
                                 int threads) {
  constexpr int across = 6;
  const double clear = std::max(1e-3, 2 * blur_);  // distance from the outline, pixels
  std::vector<uint8_t> is_wrong(pixels_.size(), 0);
  parallel_for(size_t(region_.height()), threads, [&](size_t row) {
    const int y = region_.y0 + int(row);
    std::vector<Ray> rays;
    std::vector<uint8_t> is_lamp;  // expected result
    std::vector<Hit> hits;
    for (int x = region_.x0; x < region_.x1; ++x) {
      if (!is_known(x, y)) continue;
      rays.clear();
      is_lamp.clear();
      Random random(hash_of(uint64_t(x), uint64_t(y), stream::outline_check));
      for (int k = 0; k < across * across; ++k) {
        const Vec2 jitter = random.next_vec2();
        const Vec2 place = (Vec2{float(k % across), float(k / across)} + jitter) * (1.0f / across);
        const double depth = depth_in_lamp(x, y, place);
        if (std::abs(depth) < clear) continue;
        is_lamp.push_back(depth > 0 ? 1 : 0);
        rays.push_back(camera.ray(Vec2{float(x), float(y)} + place, {0.5f, 0.5f}));
      }
      hits.resize(rays.size());
      scene.tracer.closest(rays, hits, Coherence::none, Meeting::as_seen);
      for (size_t i = 0; i < rays.size(); ++i)
        if (is_shining(scene.scene, rays[i], hits[i]) != (is_lamp[i] != 0))
          is_wrong[index(x, y)] = 1;
    }
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

std::span<const LightOutlines::Corner> LightOutlines::corners_of(const Piece& piece) const {
  return std::span(corners_).subspan(piece.first, piece.count);
}

std::span<const LightOutlines::Piece> LightOutlines::pieces_of(const Cover& cover) const {
  return std::span(pieces_).subspan(cover.first, cover.count);
}

// Returns the signed distance in pixels to the nearest side of a lamp's piece, positive inside.
double LightOutlines::depth_in_lamp(int x, int y, const Vec2& place) const {
  double depth = -std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_of(covers_[pixels_[index(x, y)] - first_known]))
    depth = std::max(depth, depth_in(corners_of(piece), Vec2d(place)).depth);
  return depth;
}

void LightOutlines::add_pieces(const Shapes& shapes, const Pixel2& pixel, Cover& cover) {
  const Vec2d origin{double(pixel.x), double(pixel.y)};
  for (std::vector<Corner> part : shapes.pieces) {
    for (Corner& c : part) c.at = c.at - origin;
    clip_to_pixel(part);
    const double area = area_of(part);
    if (!(area > 0)) continue;
    cover.mean += shapes.radiance * float(area);
    pieces_.push_back({shapes.radiance, uint32_t(corners_.size()), uint32_t(part.size())});
    corners_.insert(corners_.end(), part.begin(), part.end());
  }
}

Rgb LightOutlines::edge_correction(int x, int y, const Vec2& place, Rgb seen) const {
  const uint32_t pixel = pixels_[index(x, y)];
  if (pixel < first_known) return {};
  const Cover& cover = covers_[pixel - first_known];
  Rgb sum = cover.mean;
  bool is_in_any = false;
  const Piece* along = nullptr;  // a piece as bright as what the ray has seen
  for (const Piece& piece : pieces_of(cover)) {
    const Depth d = depth_in(corners_of(piece), Vec2d(place));
    if (std::abs(d.outline) <= blur_ && d.depth >= -blur_) {
      if (along == nullptr && luminance(seen) > 0.5f * luminance(piece.radiance)) along = &piece;
    } else if (d.depth > 0) {
      sum = sum - piece.radiance;
      is_in_any = true;
    }
  }
  // If another lamp covers the place, its light is already subtracted.
  return along != nullptr && !is_in_any ? sum - along->radiance : sum;
}

}  // namespace troffer
