// Reflection and transmission at a hit: evaluates, samples and gives densities of a material's
// scattering function. All integrators use it; make_bsdf() builds one per hit. A Bsdf is plain data
// that points into BsdfTables. docs/reference/materials.md describes each model and how well it
// conserves energy.
//
// Directions are unit vectors in the local shading frame and point away from the surface. z is the
// shading normal on the viewer's side, so wo.z > 0; wo.z <= 0 scatters nothing. wi.z > 0 is
// reflection, wi.z < 0 is transmission.
//
// Radiance leaves towards wo and arrives from wi. Radiance that enters an index of refraction n
// grows by n², and f contains this factor. Weights of refractions towards wi therefore contain
// 1/eta², eta = n(wi's side) / n(wo's side); a path that enters and leaves glass ends with a factor
// of 1. f(wo,wi) n(wi's side)² is symmetric in wo and wi. Without the factor n², no model scatters
// more energy than arrives.
//
// References: [1] Kulla & Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH
//   2017 course. [2] Wolff, "Diffuse-Reflectance Model for Smooth Dielectric Surfaces", JOSA A
//   11(11), 1994 (the geometric series below an interface). [3] Walter et al., "Microfacet Models
//   for Refraction through Rough Surfaces", EGSR 2007.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "base/warp.h"
#include "bsdf/angular_lobe.h"
#include "bsdf/clear_coat.h"
#include "bsdf/ggx_grained.h"
#include "bsdf/sheen.h"
#include "bsdf/soft_lobe.h"
#include "bsdf/tables.h"
#include "bsdf/thin_film.h"
#include "scene/scene.h"

namespace troffer {

struct Bsdf {
  enum class Fresnel : uint8_t { none, conductor, schlick, coat, glass };
  // Kind of coat over the diffuse lobe, which keeps 1 - the coat's directional albedo.
  enum class Coat : uint8_t { none, smooth_schlick, smooth_dielectric, schlick, dielectric };

  Fresnel fresnel = Fresnel::none;  // kind of the glossy lobe; none: there is no glossy lobe
  Coat coat = Coat::none;
  bool is_lambertian = false;  // diffuse / pi and nothing else
  bool is_smooth = false;      // the glossy lobe is a delta
  bool is_thin = false;        // transmission goes straight on
  bool is_pane = false;        // is_pane(material)
  bool has_transmission = false;
  bool is_within = false;      // solid glass seen from inside: its covers lie on the far side
  bool has_separable = false;  // has the soft lobe or any separable lobe below

  bool is_grained = false;  // the glossy lobe has two widths, `widths`; else `alpha`
  FacetModel facets = FacetModel::balanced;  // microfacets of the glossy lobe

  float alpha = 0;   // GGX width of the glossy lobe; with a grain: geometric mean of both
  GgxWidths widths;  // in the frame whose x axis is the grain
  Vec2 grain{1, 0};  // direction of the grain in the viewer's frame, unit
  float eta = 1;     // n(far side) / n(viewer's side); coat: n(below) / n(above)

  Rgb f0, f90;             // Schlick (weight included); conductor: eta and k
  Rgb glass_reflect;       // Fresnel::glass: factor on the reflectance
  Rgb glass_transmit;      // factor on 1 - glass_scale × reflectance
  float glass_weight = 0;  // share of the surface that is glass
  float glass_scale = 1;
  Rgb absorbed;               // in a thin sheet: Material::absorption
  Rgb reflected_share{1};     // factor on the reflectance of conductor, coat or glass
  bool is_absorbing = false;  // transmitted light enters or leaves an absorbing body

  // MaterialKind::angular: the only lobe. `grain` is then the direction of up in the front's frame.
  const AngularLobe* angular = nullptr;
  bool is_back = false;  // angular: the viewer is behind the surface

  ThinFilm film;  // for Fresnel::schlick and Fresnel::glass

  SoftLobe soft;
  SheenLayer cover;  // lies over all lobes above
  ClearCoat clear;   // lies over everything, `cover` included

  // Separable lobes: colour × g(wo) g(wi) / pi, each g = 1 - a directional albedo.
  Rgb diffuse;  // g: that of the coat, or 1
  Rgb through;  // same lobe for diffuse transmission
  // lost light of glass, reflected and transmitted (without 1/eta²)
  Rgb glass_lost_reflected, glass_lost_transmitted;
  float diffuse_mean = 1;  // cosine-weighted means of g: diffuse, glass near, glass far
  float near_mean = 0, far_mean = 0;
  float coat_f0 = 0, coat_f90 = 0;

  AlbedoRow one, grazing;  // GgxTables at this alpha
  AlbedoRow coat_row;      // CoatTable, or the light that a RoughCoatTable holds back
  AlbedoRow coat_gloss;    // albedo of the coat's gloss
  AlbedoRow near, far;     // GlassTables for light on the viewer's side and on the far side
};

struct BsdfSample {
  Vec3 wi;
  Rgb weight;     // f |cos wi| / pdf
  float pdf = 0;  // per solid angle; 0 for a delta lobe
  bool is_delta = false;
  bool is_transmission = false;
  float eta = 1;  // index of wi's side over that of wo's side; 1 for reflection
};

struct BsdfValue {
  Rgb f_cos;  // f |cos wi|
  float pdf = 0;
};

// Returns the scattering function of `material` at texture coordinates uv, for a viewer on the
// outside (is_front) or the inside. The side matters only for dielectrics, glTF's transmission and
// materials with black backs.
Bsdf make_bsdf(const BsdfTables& tables, const Scene& scene, uint32_t material,
               const TexturePlace& uv, bool is_front);
Bsdf make_bsdf(const BsdfTables& tables, const std::vector<Material>& materials,
               const std::vector<Texture>& textures, uint32_t material, const TexturePlace& uv,
               bool is_front);

// Slow path of the functions below for Bsdfs that are not Lambertian. Call those instead.
BsdfValue evaluate_general(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, bool with_pdf);
bool sample_general(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u,
                    BsdfSample& sample);

// Returns f |cos wi| and the density per solid angle with which sample() chooses wi. Delta lobes
// are left out of both. The density integrates to the probability of the other lobes, minus that of
// failed samples.
inline BsdfValue evaluate_with_pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (!bsdf.is_lambertian) return evaluate_general(bsdf, wo, wi, true);
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const float pdf = wi.z * inv_pi_f;
  return {bsdf.diffuse * pdf, pdf};
}
// Returns f |cos wi| without delta lobes.
inline Rgb evaluate(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (!bsdf.is_lambertian) return evaluate_general(bsdf, wo, wi, false).f_cos;
  return wo.z > 0 && wi.z > 0 ? bsdf.diffuse * (wi.z * inv_pi_f) : Rgb{0};
}
inline float pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  return evaluate_with_pdf(bsdf, wo, wi).pdf;
}

// Draws wi. u_lobe chooses the lobe, u the direction; both are in [0,1). Returns false if no light
// arrives this way; the sample then counts with weight 0.
inline bool sample(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u, BsdfSample& s) {
  if (!bsdf.is_lambertian) return sample_general(bsdf, wo, u_lobe, u, s);
  if (!(wo.z > 0)) return false;
  s = {};
  s.wi = cosine_hemisphere_from_square(u);
  s.weight = bsdf.diffuse;
  s.pdf = s.wi.z * inv_pi_f;
  return s.pdf > 0 && !bsdf.diffuse.is_black();
}

// Returns the share of energy from a direction of cosine cos_o that is scattered, delta lobes and
// transmission included (without the n² of radiance). Exact up to the tables for Lambertian, coated
// and glTF's opaque surfaces, smooth lobes and clear glass. An estimate for rough conductors and
// gloss under a clear coat, off by some percent. Also an estimate for rough tinted glass, whose
// tint may be off by the share that reflects.
Rgb albedo(const Bsdf& bsdf, float cos_o);

// Returns the diffuse lobe of a Bsdf, attenuated by its coat. diffuse_part and specular_part add up
// to the whole.
Bsdf diffuse_part(const Bsdf& bsdf);
// Returns all but the diffuse lobe: mirrors, gloss with its lost energy, and transmission.
Bsdf specular_part(const Bsdf& bsdf);

// Returns diffuse transmission as a diffuse lobe for light on the far side. The directions are
// those of that side's frame.
Bsdf through_part(const Bsdf& bsdf);

// Returns the share of light from cosine cos_i that the coat passes to the diffuse lobe, divided by
// its cosine-weighted mean; 1 without a coat. The lobe is separable: it sends albedo(diffuse_part,
// wo) / pi towards wo, times the irradiance in which each direction is weighted by this.
float coat_share(const Bsdf& bsdf, float cos_i);

// Returns the transmittance of a pane straight through, for wo.z > 0; 0 for other surfaces. It
// depends on the cosine alone, except for matrices.
Rgb straight_transmittance(const Bsdf& bsdf, const Vec3& wo);
// Returns the mirror reflectance of a smooth surface, such as a pane, about its own normal; 0 for
// other surfaces.
Rgb mirrored_reflectance(const Bsdf& bsdf, float cos_o);

// True if all lobes are deltas, so that next-event estimation has nothing to do.
inline bool is_purely_delta(const Bsdf& bsdf) {
  return !bsdf.has_separable && (bsdf.fresnel == Bsdf::Fresnel::none || bsdf.is_smooth) &&
         !bsdf.clear.has_rough_lobe();
}
// True if there is at most one delta per side: all mirrored light goes one way.
inline bool has_one_mirror(const Bsdf& bsdf) {
  return is_purely_delta(bsdf) && !(bsdf.clear.has_mirror() && bsdf.clear.has_normal);
}
// True for purely diffuse reflection rho / pi, which it stores in *rho unless rho is null.
inline bool is_lambertian(const Bsdf& bsdf, Rgb* rho) {
  if (bsdf.is_lambertian && rho != nullptr) *rho = bsdf.diffuse;
  return bsdf.is_lambertian;
}
inline bool has_glossy(const Bsdf& bsdf) {
  return bsdf.fresnel != Bsdf::Fresnel::none || bsdf.clear.has_lobe();
}
// Returns the smallest GGX width among the glossy lobes: 0 for a delta, 1 without a glossy lobe.
inline float glossy_alpha(const Bsdf& bsdf) {
  float alpha = 1;
  if (bsdf.is_grained)
    alpha = std::min(bsdf.widths.along, bsdf.widths.across);
  else if (bsdf.fresnel != Bsdf::Fresnel::none)
    alpha = bsdf.is_smooth ? 0.0f : bsdf.alpha;
  if (!bsdf.clear.has_lobe()) return alpha;
  return bsdf.clear.is_smooth ? 0.0f : std::min(alpha, bsdf.clear.alpha);
}

}  // namespace troffer
