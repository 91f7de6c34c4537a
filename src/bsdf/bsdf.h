// Reflection and transmission at a hit: evaluation, densities and sampling of a material's
// scattering function.
//
// Directions are unit vectors in the local shading frame, pointing away from the surface, with z
// the shading normal on the viewer's side: wo.z > 0. wi.z > 0 is reflection, wi.z < 0
// transmission. wo.z <= 0 scatters nothing. A Bsdf is plain data that points into BsdfTables.
//
// wo is where radiance leaves to, wi where it comes from. Radiance that crosses into an index of
// refraction n grows by n²; f carries that factor, so weights of refractions towards wi contain
// 1/eta², eta = n(wi's side) / n(wo's side), and a path that enters and leaves glass ends with 1.
// f(wo,wi) n(wi's side)² is symmetric in wo and wi; with that factor taken out, every model sends
// at most the energy on that comes in.
//
// Models, all with rgb inputs clamped to [0,1] (no surface makes energy):
// - FacetModel: all that follows about lost energy holds for balanced facets. Those that scatter
//   once (bsdf/facet_lobe.h) lose it, as Mitsuba defines them.
// - Smooth (alpha < smooth_alpha) glossy lobes are delta lobes: absent from evaluate and pdf.
// - Rough ones are GGX, height-correlated Smith. Energy lost between microfacets returns as a
//   reciprocal diffuse lobe [1]: for conductors and glTF's metals scaled by the mean Fresnel
//   reflectance; for glass in both half spaces, split by the mean transmittance.
// - Where gloss has a grain, GGX has two widths; what is lost between microfacets returns by a fit
//   to its albedo over cosine and azimuth where the widths are even, else it stays lost.
// - A thin film over glTF's gloss gives it the film's reflectance in place of Schlick's and of
//   glass's own (bsdf/thin_film.h), for the share of the surface that wears it. What that leaves
//   for a diffuse base is taken from a Schlick curve that nowhere lies below it.
// - A clear coat lies over everything else, sheen too: bsdf/clear_coat.h; of glass, over its
// outside
//   or both sides of a sheet: bsdf/coated_glass.h.
// - Sheen lies over everything else, which keeps p = 1 - its albedo × the largest of its colours:
//   gloss the smaller p of both directions, as KHR_materials_sheen has it, the diffuse lobe and
//   what is lost between microfacets their product, over its mean, so that white ones reflect what
//   is left. Solid glass has it outside, sheets on both sides; what it takes of light that leaves
//   glass is lost.
// - coated_diffuse: dielectric coat over a Lambertian base with all inter-reflections below the
//   coat: f = T(wo) T(wi) rho / (pi eta² (1 - rho F)), T = 1 - E, E the coat's directional albedo,
//   F = 1 - (1 - E_avg) / eta² its mean reflectance from below [2]. A white base reflects all.
// - metallic_roughness: glTF's mix of a Schlick metal and a Schlick coat over a Lambertian base,
//   here (1 - E(wo))(1 - E(wi)) / (1 - E_avg) rho / pi so that a white one reflects all [1]. E
//   takes the largest channel of a coloured specular, as KHR_materials_specular asks. The share
//   that transmits is glass of exact Fresnel reflectance scaled by specular and specular_color,
//   tinted by base_color on the way through; its compensation ignores that scaling.
// - Diffuse transmission: light that falls on the far side leaves this one by the diffuse lobe's
//   law, its coat included, with `through` in place of `diffuse`. The functions below leave it out,
//   but albedo(): who meets such a surface takes both sides, each with its part
//   (transport/two_sides.h).
// - Thin sheets: R = 2r / (1 + r) for each polarisation, the rest goes straight on. Rough thin
//   sheets transmit GGX's reflection lobe mirrored to the other side, as glTF's viewers do, with
//   R's roughness.
//
// How well energy is kept, measured at cosines of 0.02 and more and all alpha (the white furnace
// tests): white opaque surfaces reflect 0.9985 to 1.001 of the light; lossless glass sends on 0.998
// to 1.001 seen from the thinner side, 0.995 to 1.006 from the denser, where the kink of total
// reflection limits the tables.
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
  // How the coat over the diffuse lobe attenuates it: 1 - directional albedo.
  enum class Coat : uint8_t { none, smooth_schlick, smooth_dielectric, schlick, dielectric };

  Fresnel fresnel = Fresnel::none;  // of the glossy lobe; none: there is no glossy lobe
  Coat coat = Coat::none;
  bool is_lambertian = false;  // diffuse / pi and nothing else
  bool is_smooth = false;      // the glossy lobe is a delta
  bool is_thin = false;        // transmission goes straight on
  bool is_pane = false;        // is_pane(material)
  bool has_transmission = false;
  bool is_within = false;      // solid glass seen from inside: what covers it lies on the far side
  bool has_separable = false;  // the soft lobe, or any of the cosine-shaped ones below

  bool is_grained = false;                   // the glossy lobe has `widths`, else alpha all around
  FacetModel facets = FacetModel::balanced;  // of the glossy lobe

  float alpha = 0;   // GGX width of the glossy lobe; grained: the geometric mean of both
  GgxWidths widths;  // in the frame whose x axis is the grain
  Vec2 grain{1, 0};  // … in the viewer's frame, unit
  float eta = 1;     // n(far side) / n(viewer's side); coat: n(below) / n(above)

  Rgb f0, f90;             // Schlick (its weight included); conductor: eta and k
  Rgb glass_reflect;       // Fresnel::glass: factor on the reflectance
  Rgb glass_transmit;      // … on 1 - glass_scale × reflectance
  float glass_weight = 0;  // share of the surface that is glass
  float glass_scale = 1;
  Rgb absorbed;               // of a sheet: Material::absorption
  Rgb reflected_share{1};     // factor on all that conductor, coat or glass reflects
  bool is_absorbing = false;  // what goes through comes into a body that absorbs, or out of one

  ThinFilm film;  // Fresnel::schlick and glass

  SoftLobe soft;
  SheenCover cover;  // over all of these
  ClearCoat clear;   // over all of them

  // Separable lobes: colour × g(wo) g(wi) / pi, each g = 1 - a directional albedo.
  Rgb diffuse;                     // g of the coat, or 1
  Rgb through;                     // the same for diffuse transmission
  Rgb glass_again, glass_through;  // glass's: reflected, transmitted (without 1/eta²)
  float diffuse_mean = 1;          // cosine-weighted mean of the g of each
  float near_mean = 0, far_mean = 0;
  float coat_f0 = 0, coat_f90 = 0;

  AlbedoRow one, grazing;  // GgxTables at this alpha
  AlbedoRow coat_row;      // CoatTable, or what a RoughCoatTable does not let through
  AlbedoRow coat_gloss;    // what the coat reflects as gloss
  AlbedoRow near, far;     // GlassTables for light on the viewer's side, on the far side
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

// The scattering function of material `material` at texture coordinates uv, for a viewer on the
// outside (is_front) or the inside. The side matters to dielectrics, to glTF's transmission and to
// materials with black backs only: all else reflects alike on both.
Bsdf make_bsdf(const BsdfTables& tables, const Scene& scene, uint32_t material,
               const TexturePlace& uv, bool is_front);
Bsdf make_bsdf(const BsdfTables& tables, const std::vector<Material>& materials,
               const std::vector<Texture>& textures, uint32_t material, const TexturePlace& uv,
               bool is_front);

// For Bsdfs that are more than Lambertian; call those below.
BsdfValue evaluate_general(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, bool with_pdf);
bool sample_general(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u,
                    BsdfSample& sample);

// f |cos wi| and the density with which sample() chooses wi, per solid angle. Delta lobes count in
// neither: the density integrates to the probability of the other lobes, less that of samples that
// fail.
inline BsdfValue evaluate_with_pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (!bsdf.is_lambertian) return evaluate_general(bsdf, wo, wi, true);
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const float pdf = wi.z * inv_pi_f;
  return {bsdf.diffuse * pdf, pdf};
}
// f |cos wi| without delta lobes.
inline Rgb evaluate(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (!bsdf.is_lambertian) return evaluate_general(bsdf, wo, wi, false).f_cos;
  return wo.z > 0 && wi.z > 0 ? bsdf.diffuse * (wi.z * inv_pi_f) : Rgb{0};
}
inline float pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  return evaluate_with_pdf(bsdf, wo, wi).pdf;
}

// Draws wi. u_lobe chooses the lobe, u the direction; both in [0,1). False: no light this way (the
// sample counts with weight 0).
inline bool sample(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u, BsdfSample& s) {
  if (!bsdf.is_lambertian) return sample_general(bsdf, wo, u_lobe, u, s);
  if (!(wo.z > 0)) return false;
  s = {};
  s.wi = cosine_hemisphere_from_square(u);
  s.weight = bsdf.diffuse;
  s.pdf = s.wi.z * inv_pi_f;
  return s.pdf > 0 && !bsdf.diffuse.is_black();
}

// Share of the energy from a direction of cosine cos_o that scatters on, delta lobes and
// transmission included (without the n² of radiance). Exact up to the tables for Lambertian,
// coated and glTF's opaque surfaces, smooth lobes and clear glass; an estimate for rough conductors
// and gloss under a clear coat (some percent) and rough tinted glass (the tint may be off by the
// share that reflects).
Rgb albedo(const Bsdf& bsdf, float cos_o);

// The two parts of a Bsdf: together they scatter what it scatters. The diffuse lobe, attenuated by
// its coat …
Bsdf diffuse_part(const Bsdf& bsdf);
// … and all else: mirrors, gloss with its lost energy, everything that transmits.
Bsdf specular_part(const Bsdf& bsdf);

// What diffuse transmission does with light on the far side, for a viewer of whom the same is said
// in that side's frame: a diffuse lobe.
Bsdf through_part(const Bsdf& bsdf);

// What the coat lets through to the diffuse lobe from a direction of cosine cos_i, over its mean by
// the cosine; 1 without a coat. The lobe is separable: what it sends to wo is albedo(diffuse_part,
// wo) / pi times the irradiance in which every direction counts by this.
float coat_share(const Bsdf& bsdf, float cos_i);

// What a pane lets through straight on, seen at a cosine > 0; 0 of all else.
Rgb straight_transmittance(const Bsdf& bsdf, float cos_o);
// What a smooth surface, such as a pane, reflects as a mirror, by its own normal; 0 of all else.
Rgb mirrored_reflectance(const Bsdf& bsdf, float cos_o);

// Nothing for next-event estimation to do.
inline bool is_purely_delta(const Bsdf& bsdf) {
  return !bsdf.has_separable && (bsdf.fresnel == Bsdf::Fresnel::none || bsdf.is_smooth) &&
         !bsdf.clear.has_rough_lobe();
}
// A delta on either side at most: all that it mirrors goes one way.
inline bool has_one_mirror(const Bsdf& bsdf) {
  return is_purely_delta(bsdf) && !(bsdf.clear.has_mirror() && bsdf.clear.has_normal);
}
// Purely diffuse reflection rho / pi; rho may be null.
inline bool is_lambertian(const Bsdf& bsdf, Rgb* rho) {
  if (bsdf.is_lambertian && rho != nullptr) *rho = bsdf.diffuse;
  return bsdf.is_lambertian;
}
inline bool has_glossy(const Bsdf& bsdf) {
  return bsdf.fresnel != Bsdf::Fresnel::none || bsdf.clear.has_lobe();
}
// GGX width of what is glossy: 0 where it is a delta, 1 where there is none; the smallest of
// several.
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
