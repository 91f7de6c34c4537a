// Whole pictures, rendered with many seeds, and statistics of their pixels.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/render.h"
#include "support/chi_square.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace troffer::test {

inline const StopFlag never_stopped = false;

inline RenderResult render_now(const PreparedScene& scene, const Camera& camera,
                               const RenderOptions& options) {
  return render(scene, camera, options, {}, never_stopped);
}

// Renders reflected light alone, in a picture of this size.
inline Image reflected_light(const PreparedScene& scene, const Camera& camera, int width,
                             int height, RenderOptions options) {
  options.width = width;
  options.height = height;
  options.threads = 2;
  options.aovs = {Aov::indirect};
  return render_now(scene, camera, options).layers.at(1).image;
}

// True if all layers are bit-identical.
inline bool is_identical(const std::vector<Layer>& a, const std::vector<Layer>& b) {
  if (a.size() != b.size()) return false;
  for (size_t l = 0; l < a.size(); ++l) {
    const auto &p = a[l].image.pixels, &q = b[l].image.pixels;
    if (a[l].name != b[l].name || a[l].image.width != b[l].image.width || p.size() != q.size() ||
        std::memcmp(p.data(), q.data(), p.size() * sizeof(Rgb)) != 0)
      return false;
  }
  return true;
}

// Counts the pixels of a crop, over all layers, that differ from those of the whole picture.
// Returns all of them if sizes do not match.
inline size_t pixels_off_crop(const RenderResult& whole, const RenderResult& part,
                              const std::array<int, 4>& crop) {
  size_t off = 0;
  for (size_t l = 0; l < whole.layers.size(); ++l) {
    const Image &a = part.layers.at(l).image, &b = whole.layers[l].image;
    if (a.width != crop[2] - crop[0] || a.height != crop[3] - crop[1]) return b.pixels.size();
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x)
        off += !(a.at(x, y) == b.at(x + crop[0], y + crop[1])) ? 1 : 0;
  }
  return off;
}

inline double mean_green(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(p.g);
  return sum / double(image.pixels.size());
}
inline double mean(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(p.r) + double(p.g) + double(p.b);
  return sum / double(3 * image.pixels.size());
}
inline bool is_finite(const Image& image) {
  for (const Rgb& p : image.pixels)
    if (!troffer::is_finite(p)) return false;
  return true;
}

// Green channels of `sets` pictures with seeds options.seed, options.seed + 1 and so on: moments
// per pixel, and of the pictures' means.
struct Ensemble {
  std::vector<Moments> pixels;
  Moments mean;
};
inline Ensemble render_ensemble(const PreparedScene& scene, const Camera& camera,
                                RenderOptions options, int sets) {
  Ensemble e;
  for (int s = 0; s < sets; ++s) {
    const Image image = render_now(scene, camera, options).layers[0].image;
    e.pixels.resize(image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); ++i) e.pixels[i].add(double(image.pixels[i].g));
    e.mean.add(mean_green(image));
    ++options.seed;
  }
  return e;
}

// Counts the pixels that differ from `expected` by more than chance allows. All pixels together may
// fail once in a thousand runs.
inline size_t pixels_off(const Ensemble& e, const std::function<double(size_t)>& expected,
                         double rounding) {
  const double significance = sidak(1e-3, int(e.pixels.size()));
  size_t off = 0;
  for (size_t i = 0; i < e.pixels.size(); ++i)
    off += p_of_mean(e.pixels[i], expected(i), rounding * std::abs(expected(i))) < significance;
  return off;
}

// A grey room with a ceiling light, a glass block, a mirror ball and a glossy floor.
inline Scene mixed_room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  const auto quads = add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  Material floor;
  floor.kind = MaterialKind::coated_diffuse;
  floor.base_color.value = Rgb{0.4f, 0.5f, 0.6f};
  floor.roughness.value = 0.15f;
  s.meshes[quads[0]].material = add_material(s, floor);
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.is_reflectance = true;
  mirror.base_color.value = Rgb{0.9f};
  s.spheres.push_back({{0.8f, 0.5f, 0.5f}, 0.5f, false, add_material(s, mirror), no_light});
  Material glass;
  glass.kind = MaterialKind::dielectric;
  glass.base_color.value = Rgb{1};
  s.spheres.push_back({{-0.6f, 0.9f, 0.4f}, 0.4f, false, add_material(s, glass), no_light});
  add_ceiling_light(s, 1, 2.4f, Rgb{8, 7, 6});
  return s;
}
inline Camera mixed_room_camera() {
  return look_at({-1.2f, -1.8f, 1.4f}, {0.3f, 0.8f, 0.6f}, {0, 0, 1}, 60);
}

}  // namespace troffer::test
