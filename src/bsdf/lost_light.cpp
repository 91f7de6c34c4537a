// Compensation of the energy lost to single scattering: light that microfacets scatter more than
// once.
// References: [1] Kulla & Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
//   course.
#include <algorithm>
#include <cmath>

#include "bsdf/bsdf_inputs.h"
#include "bsdf/gains.h"

namespace troffer {

// Multiple scattering between conducting microfacets of mean reflectance f [1]: the geometric
// series of reflections after the first, f² E / (1 - f (1 - E)). `weight` is the metal's share of
// the surface.
void add_metal_compensation(Bsdf& b, const Inputs& in, Rgb f, float weight) {
  if (b.is_smooth || weight == 0 || b.facets != FacetModel::balanced) return;
  const bool is_clear = b.clear.share > 0 && !b.is_within;
  const GrainTable* grain = (b.is_grained || is_clear) && in.prepared.grain >= 0
                                ? &in.tables.grain(in.prepared.grain)
                                : nullptr;
  if ((b.is_grained || (is_clear && b.clear.bend > 1)) && grain == nullptr) return;
  const float escape = grain ? grain->even_row().average : b.one.average, stay = 1 - escape;
  if (stay < negligible) return;
  const Rgb colour = f * f * (weight * escape / stay) / (Rgb{1} - f * stay);
  if (colour.is_black()) return;
  b.soft.kind = b.is_grained ? SoftLobe::Kind::lost_grained_light : SoftLobe::Kind::lost_light;
  b.soft.colour = colour;
  b.soft.mean = stay;
  b.soft.glossy = grain ? grain->even_row() : b.one;
  if (grain) b.soft.twice = grain->twice_row();
  b.has_separable = true;
  if (!is_clear && !(b.cover.share > 0)) return;
  b.soft.mean = hemisphere_mean([&b](float c) { return gains_at(b, {0, 0, c}).soft; });
  b.soft.colour *= stay / b.soft.mean;
}

// Lost energy of glass leaves on both sides. Reciprocity requires t_near M_near = t_far M_far eta²
// of the shares transmitted from the near and far side (M: mean missing energy). Mean Fresnel
// transmittances satisfy it where M_near = M_far; the geometric mean below corrects them elsewhere.
void add_glass_compensation(Bsdf& b, const Inputs& in, Rgb tint) {
  const FilmGlassTable* film = film_glass_of(b, in);
  // Without a table the film's mean reflectance is unknown, and the lost energy stays lost.
  if (b.is_smooth || b.facets != FacetModel::balanced) return;
  if (b.film.share > 0 && !b.is_thin && !film) return;
  b.near_mean = 1 - b.near.average;
  b.far_mean = 1 - b.far.average;
  if (b.clear.share > 0 || b.cover.share > 0) {
    b.near_mean = hemisphere_mean([&b](float c) { return gains_at(b, {0, 0, c}).glass; });
    b.far_mean = hemisphere_mean([&b](float c) { return far_glass_gain(b, c); });
  }
  if (b.near_mean < negligible || b.far_mean < negligible) return;
  const float ior = in.prepared.ior;
  // Per channel: lost energy over the channels' mean, and its share that leaves on the other side.
  Rgb lost{1}, far_lost{1}, through{1 - in.prepared.plate_average};
  if (film) {
    lost = (in.is_front ? film->outside : film->inside).lost;
    far_lost = (in.is_front ? film->inside : film->outside).lost;
  }
  for (size_t c = 0; c < 3 && !b.is_thin; ++c) {
    const float from_outside = 1 - (film ? film->reflected[c] : in.prepared.dielectric_average);
    const float from_inside = from_outside / (ior * ior);
    const float ratio = std::sqrt(b.far_mean * far_lost[c] / (b.near_mean * lost[c]));
    const float near = (in.is_front ? from_outside : from_inside) * ratio;
    const float far = (in.is_front ? from_inside : from_outside) / ratio;
    through[c] = near / std::max(1.0f, std::max(near, far));
  }
  b.glass_lost_reflected =
      lost * (Rgb{1} - through) * (b.glass_weight / b.near_mean) * b.reflected_share;
  b.glass_lost_transmitted = tint * lost * through * (b.glass_weight / b.far_mean);
  b.has_separable = true;
}

}  // namespace troffer
