#include "bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake/cut_off.h"
#include "bake/page.h"
#include "bake/sent_light.h"
#include "bake/sides.h"
#include "bake/vertex_sites.h"
#include "base/units.h"
#include "image/encode.h"
#include "image/exposure.h"
#include "image/tone_map.h"
#include "render/cell_pilot.h"
#include "render/preparation.h"

namespace troffer {

namespace {

constexpr double share_of_sides = 0.05;  // share of the progress for finding lit sides
// Share of texels that may be brighter than white.
constexpr double most_clipped = 0.001;

MethodSettings settings_of(const BakeOptions& o) {
  MethodSettings settings;
  settings.indirect = o.light.indirect;
  settings.shadow_rays = o.light.method.row().rays_of_measuring_sample;
  settings.error = o.light.error;
  settings.viewing_rays = o.samples;
  settings.trees = o.light.kj92.sampling;
  settings.depth = o.light.depth;
  settings.threads = o.light.threads;
  return settings;
}

// State of one baking run.
class Baking {
 public:
  Baking(const PreparedScene& scene, const BakeOptions& options, const ProgressCallback& progress,
         const StopFlag& stop)
      : scene_(scene),
        options_(options),
        settings_(settings_of(options)),
        progress_(progress),
        stop_(stop),
        lx_per_unit_(scene.scene.is_photometric ? 1 : float(luminous_efficacy)) {}
  BakeResult run();

 private:
  const PreparedScene& scene_;
  const BakeOptions& options_;
  const MethodSettings settings_;
  const ProgressCallback& progress_;
  const StopFlag& stop_;
  const float lx_per_unit_;
  BakeResult result_;

  SiteSettings site_settings() const {
    return {options_.samples, options_.light.threads, options_.light.seed, false,
            options_.light.indirect != Indirect::none && options_.light.depth != 0 &&
                options_.light.depth != 1};
  }
  std::vector<SiteLight> light(const Integrator& integrator, const SiteList& sites,
                               const SiteSettings& settings);
  void add_texels(const BakedSurfaces& surfaces, const TexelSites& sites,
                  const std::vector<SiteLight>& light);
  void add_irradiance(const TexelSites& sites, const std::vector<SiteLight>& light);
  void add_pictures(const BakedSurfaces& surfaces, const TexelSites& sites,
                    const std::vector<SiteLight>& light);
  void add_vertices(const BakedSurfaces& surfaces, const VertexSites& sites,
                    const std::vector<SiteLight>& light);
  void count(const BakedSurfaces& surfaces, const std::vector<SiteLight>& light);
  void note(const std::string& name, const std::string& json) {
    result_.baked.notes.emplace_back(name, json);
  }
  double exposure(const std::vector<Rgb>& sent) const;
};

// Returns the light of all sites in lx, and reports progress.
std::vector<SiteLight> Baking::light(const Integrator& integrator, const SiteList& sites,
                                     const SiteSettings& settings) {
  const auto tell = [&](double f) {
    if (progress_) progress_(share_of_sides + (1 - share_of_sides) * f);
  };
  std::vector<SiteLight> light =
      light_sites(scene_, integrator, sites, settings, tell, stop_, result_.counters);
  for (SiteLight& l : light) {
    l.irradiance = l.irradiance * lx_per_unit_;
    l.error *= lx_per_unit_;
  }
  return light;
}

void Baking::count(const BakedSurfaces& surfaces, const std::vector<SiteLight>& light) {
  BakeFigures& f = result_.figures;
  f.charts = surfaces.charts;
  f.stands = surfaces.stands.size();
  f.degenerate = surfaces.degenerate;
  double sum = 0, squares = 0;
  for (const SiteLight& l : light) {
    if (!l.is_known) continue;
    ++f.sites;
    sum += double(luminance(l.irradiance));
    squares += sqr(double(l.error));
  }
  if (f.sites == 0) return;
  f.mean_lx = sum / double(f.sites);
  f.error_lx = std::sqrt(squares / double(f.sites));
}

// Returns pages that hold value(i) for each site, with gutters filled.
template <class Value>
std::vector<Page> pages_of(const Atlas& atlas, int gutter, const TexelSites& sites,
                           const std::vector<SiteLight>& light, const Value& value) {
  std::vector<Page> pages(size_t(atlas.pages), Page(atlas.size));
  for (size_t i = 0; i < light.size(); ++i) {
    const TexelSites::Texel& t = sites.texels()[i];
    pages[size_t(atlas.page[t.stand])].set(t.x, t.y, t.chart, value(i), light[i].is_known);
  }
  for (Page& page : pages) page.fill(gutter);
  return pages;
}

// Returns a white value that all but a share most_clipped of the values stay below.
double white_of(std::vector<float> values) {
  if (values.empty()) return 1;
  const auto at = std::ptrdiff_t(double(values.size() - 1) * (1 - most_clipped));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  const double white = double(values[size_t(at)]);
  return white > 0 && std::isfinite(white) ? white : 1;
}

struct PngLook {
  double scale = 1;  // factor on values before encoding
  bool has_alpha = false, is_deep = false;
};

std::vector<uint8_t> png_of(const Page& page, const PngLook& look) {
  const int size = page.size(), channels = look.has_alpha ? 4 : 3;
  std::vector<float> values;
  values.reserve(size_t(size) * size_t(size) * size_t(channels));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const PageTexel& t = page.at(x, y);
      for (size_t k = 0; k < 3; ++k)
        values.push_back(
            srgb_from_linear(std::clamp(float(double(t.color[k]) * look.scale), 0.0f, 1.0f)));
      if (look.has_alpha) values.push_back(std::clamp(t.alpha, 0.0f, 1.0f));
    }
  if (look.is_deep) return encode_png_texels(size, size, channels, values);
  std::vector<uint8_t> bytes;
  bytes.reserve(values.size());
  for (const float v : values) bytes.push_back(uint8_t(v * 255 + 0.5f));
  return encode_png_texels(size, size, channels, bytes);
}

void Baking::add_irradiance(const TexelSites& sites, const std::vector<SiteLight>& light) {
  const std::vector<Page> pages =
      pages_of(result_.atlas, options_.atlas.gutter, sites, light, [&](size_t i) {
        return PageTexel{light[i].irradiance, 1, light[i].error};
      });
  std::vector<float> brightest;
  for (const SiteLight& l : light)
    if (l.is_known) brightest.push_back(max_component(l.irradiance));
  const double white = white_of(std::move(brightest));
  for (const Page& page : pages) {
    Image irradiance(page.size(), page.size()), error(page.size(), page.size());
    for (int y = 0; y < page.size(); ++y)
      for (int x = 0; x < page.size(); ++x) {
        irradiance.at(x, y) = page.at(x, y).color;
        error.at(x, y) = Rgb{page.at(x, y).error};
      }
    result_.irradiance.push_back(std::move(irradiance));
    result_.error.push_back(std::move(error));
    if (options_.shading == BakedShading::lightmap)
      result_.baked.pages.push_back(png_of(page, {1 / white, false, false}));
  }
  if (options_.shading != BakedShading::lightmap) return;
  result_.baked.white = white;
  note("lightmap", fmt::format("{{\"unit\":\"lx\",\"white\":{}}}", white));
}

double Baking::exposure(const std::vector<Rgb>& sent) const {
  if (options_.exposure_stops) return *options_.exposure_stops;
  Image all(int(std::min<size_t>(sent.size(), 1 << 24)), 1);
  std::copy(sent.begin(), sent.begin() + all.width, all.pixels.begin());
  const Brightness b = brightness(all);
  return b.is_black ? 0 : b.auto_stops;
}

// Adds pictures of the light that surfaces send, for files without lights.
void Baking::add_pictures(const BakedSurfaces& surfaces, const TexelSites& sites,
                          const std::vector<SiteLight>& light) {
  const SentLight base(scene_.scene);
  std::vector<PageTexel> sent(light.size());
  parallel_for(light.size(), options_.light.threads, [&](size_t i) {
    sent[i] = base.base(surfaces, result_.atlas, sites, i);
    sent[i].color = sent[i].color * light[i].irradiance * inv_pi_f;
  });
  const std::vector<Page> pages = pages_of(result_.atlas, options_.atlas.gutter, sites, light,
                                           [&](size_t i) { return sent[i]; });
  std::vector<Rgb> known;
  float most = 0;
  PngLook look;
  for (size_t i = 0; i < sent.size(); ++i) {
    look.has_alpha = look.has_alpha || sent[i].alpha < 1;
    if (light[i].is_known) known.push_back(sent[i].color);
    most = std::max(most, max_component(sent[i].color));
  }
  if (options_.shading == BakedShading::emissive) {
    result_.baked.white = most > 0 ? double(most) : 1;
    look.scale = 1 / result_.baked.white;
    look.is_deep = true;
    look.has_alpha = false;
    note("emission", fmt::format("{{\"unit\":\"cd/m2\",\"white\":{}}}", result_.baked.white));
  } else {
    const double stops = exposure(known);
    look.scale = std::exp2(stops);
    note("unlit",
         fmt::format("{{\"exposure_stops\":{},\"white_cd_per_m2\":{}}}", stops, 1 / look.scale));
  }
  for (const Page& page : pages) result_.baked.pages.push_back(png_of(page, look));
}

void Baking::add_texels(const BakedSurfaces& surfaces, const TexelSites& sites,
                        const std::vector<SiteLight>& light) {
  add_irradiance(sites, light);
  if (options_.shading != BakedShading::lightmap) add_pictures(surfaces, sites, light);
  const Atlas& atlas = result_.atlas;
  note("atlas", fmt::format("{{\"pages\":{},\"size\":{},\"texels_per_metre\":{}}}", atlas.pages,
                            atlas.size, atlas.texels_per_metre));
  for (size_t s = 0; s < surfaces.stands.size(); ++s) {
    const Stand& stand = surfaces.stands[s];
    BakedSurface& surface =
        (stand.is_instance ? result_.baked.instances : result_.baked.meshes)[stand.number];
    surface.page = atlas.page[s];
    for (const Vec2& at : atlas.texel_of_vertex[s])
      surface.uvs.push_back(at * (1.0f / float(atlas.size)));
  }
  if (atlas.coarser > 0)
    result_.warnings.push_back(
        {"a surface that fits on no page gets fewer texels than requested", atlas.coarser});
}

void Baking::add_vertices(const BakedSurfaces& surfaces, const VertexSites& sites,
                          const std::vector<SiteLight>& light) {
  // Only base colours count for exposure; textures are ignored.
  std::vector<Rgb> sent;
  for (size_t s = 0; s < surfaces.stands.size(); ++s) {
    const Material& m =
        surfaces.scene.materials[surfaces.charted[surfaces.stands[s].charted].mesh.material];
    for (size_t i = sites.first_of(s); i < sites.first_of(s + 1); ++i)
      if (light[i].is_known) sent.push_back(m.base_color.value * light[i].irradiance * inv_pi_f);
  }
  const double stops = exposure(sent);
  const auto scale = float(std::exp2(stops) * double(inv_pi_f));
  for (size_t s = 0; s < surfaces.stands.size(); ++s) {
    const Stand& stand = surfaces.stands[s];
    BakedSurface& surface =
        (stand.is_instance ? result_.baked.instances : result_.baked.meshes)[stand.number];
    for (size_t i = sites.first_of(s); i < sites.first_of(s + 1); ++i)
      surface.colors.push_back(light[i].irradiance * scale);
  }
  note("vertex_colors",
       fmt::format("{{\"exposure_stops\":{},\"lx_per_color\":{}}}", stops, 1 / double(scale)));
}

BakeResult Baking::run() {
  CellInput cells{surfaces_pilot(scene_, options_.light.seed),
                  nullptr,
                  options_.light.seed,
                  nullptr,
                  stop_,
                  {},
                  {},
                  options_.light.cells};
  const std::unique_ptr<Integrator> integrator =
      make_integrator(scene_, options_.light.method, settings_, options_.light.preparation, &cells);
  if (!integrator) return {};
  BakedSurfaces surfaces = surfaces_of(scene_.scene, options_.light.threads);
  const size_t before = surfaces.stands.size();
  const auto sides = lit_sides(scene_, *integrator, surfaces, site_settings(), stop_);
  if (stop_.load(std::memory_order_relaxed)) return {};
  surfaces = with_sides(std::move(surfaces), sides);
  if (options_.shading == BakedShading::emissive) lift_layers(surfaces);
  result_.figures.layered = surfaces.stands.size() - std::min(before, surfaces.stands.size());
  result_.baked.shading = options_.shading;
  result_.baked.meshes.resize(surfaces.scene.meshes.size());
  result_.baked.instances.resize(surfaces.scene.instances.size());
  if (options_.shading == BakedShading::vertex_colors) {
    const VertexSites sites(surfaces);
    const std::vector<SiteLight> found = light(*integrator, sites, site_settings());
    if (stop_.load(std::memory_order_relaxed)) return {};
    add_vertices(surfaces, sites, found);
    count(surfaces, found);
  } else {
    result_.atlas = make_atlas(surfaces, options_.atlas);
    const TexelSites sites(surfaces, result_.atlas);
    SiteSettings settings = site_settings();
    settings.are_texels = true;
    std::vector<SiteLight> found = light(*integrator, sites, settings);
    if (stop_.load(std::memory_order_relaxed)) return {};
    if (settings.is_all_light) forget_cut_off_texels(scene_, sites, result_.atlas, found);
    add_texels(surfaces, sites, found);
    count(surfaces, found);
  }
  for (const Warning& w : surfaces.warnings.entries()) result_.warnings.push_back(w);
  result_.scene = std::move(surfaces.scene);
  result_.is_complete = true;
  return std::move(result_);
}

}  // namespace

BakeResult bake(const PreparedScene& scene, const BakeOptions& options,
                const ProgressCallback& progress, const StopFlag& stop) {
  return Baking(scene, options, progress, stop).run();
}

}  // namespace troffer
