// Builds a Bsdf from a material at a hit: one function per material model.
#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/bsdf_inputs.h"
#include "bsdf/fresnel.h"
#include "bsdf/gains.h"

namespace troffer {

namespace {

void set_lambertian(Bsdf& b, Rgb rho) {
  b.is_lambertian = b.has_separable = true;
  b.diffuse = rho;
}

// Share of incident light that diffuse transmission takes, and the transmitted colour.
struct Passing {
  float share = 0;
  Rgb through;
};
Passing passing(const Inputs& in) {
  const Material& m = in.material;
  if (!(m.diffuse_transmission.value > 0)) return {};
  const float share = in.value(m.diffuse_transmission);
  return {share, safe01(evaluate(in.textures, m.diffuse_transmission_color, in.uv)) * share};
}

// Scales reflection and diffuse transmission so that their sum is at most 1 per channel.
void set_diffuse(Bsdf& b, const Inputs& in) {
  Rgb rho = in.base(), through = passing(in).through;
  if (!through.is_black()) {
    for (size_t k = 0; k < 3; ++k) {
      const float both = std::max(rho[k] + through[k], 1.0f);
      rho[k] /= both;
      through[k] /= both;
    }
    b.through = through;
  }
  set_lambertian(b, rho);
}

// Sets the microfacet widths along and across the grain. Leaves one width if both are equal.
void set_grain(Bsdf& b, const Inputs& in, float strength) {
  b.widths = widths_of(b.alpha, strength);
  if (!(b.widths.along > b.widths.across)) return;
  b.is_grained = true;
  b.alpha = std::sqrt(b.widths.along * b.widths.across);
  // The grain is given in the front side's frame; the back side's frame has the same x axis.
  b.grain = in.is_front ? in.uv.grain : Vec2{in.uv.grain.x, -in.uv.grain.y};
  const Vec3 n = b.clear.normal;
  b.clear.normal = {b.grain.x * n.x + b.grain.y * n.y, b.grain.x * n.y - b.grain.y * n.x, n.z};
}

void set_roughness(Bsdf& b, const Inputs& in, bool can_have_grain = false) {
  b.alpha = base_alpha(in.material, in.value(in.material.roughness), b.clear);
  if (can_have_grain && in.material.anisotropy.value > 0)
    set_grain(b, in, in.value(in.material.anisotropy));
  b.is_smooth = b.alpha < smooth_alpha;
  if (b.is_smooth) return;
  if (in.material.kind != MaterialKind::metallic_roughness) b.facets = in.material.facets;
  b.one = in.tables.ggx().one.row(b.alpha);
  b.grazing = in.tables.ggx().grazing.row(b.alpha);
}

// Call before the layers below are set: their widths and means depend on the coat.
void set_clear_coat(Bsdf& b, const Inputs& in) {
  const Material& m = in.material;
  if (!has_clear_coat(m)) return;
  b.clear =
      clear_coat_of(m, in.value(m.coat), in.value(m.coat_roughness), in.prepared.clear_coat_ior);
  in.tables.set_rows(b.clear, in.prepared);
  b.clear.is_shown = !b.is_within;
  if (!has_own_coat_normal(m)) return;
  // The normal is given in the front side's frame.
  const Vec2 n = in.is_front ? in.uv.coat_normal : Vec2{-in.uv.coat_normal.x, in.uv.coat_normal.y};
  b.clear.has_normal = true;
  b.clear.normal = {n.x, n.y, std::sqrt(std::max(0.0f, 1 - n.x * n.x - n.y * n.y))};
}

// Returns the cosine-weighted mean of the diffuse lobe's g.
float mean_coat_gain(const Bsdf& b) {
  return hemisphere_mean([&b](float c) { return gains_at(b, {0, 0, c}).diffuse; });
}

Rgb metal_mean(Rgb eta, Rgb k) {
  Rgb mean;
  for (size_t i = 0; i < 3; ++i)
    mean[i] = hemisphere_mean([&](float c) { return fresnel_conductor(c, eta[i], k[i]); });
  return mean;
}

// Makes a share `weight` of the surface glass that reflects scale × F and transmits tint × the
// rest.
void add_glass(Bsdf& b, const Inputs& in, float weight, Rgb scale, Rgb tint) {
  b.fresnel = Bsdf::Fresnel::glass;
  b.has_transmission = true;
  b.glass_weight = weight;
  b.glass_reflect = scale * weight;
  b.glass_scale = max_component(scale);
  b.glass_transmit = tint * weight;
  const float ior = in.prepared.ior;
  b.is_thin = is_sheet(in);
  if (in.material.is_thin)
    b.absorbed = safe_depth(in.material.absorption);
  else
    b.is_absorbing = !in.material.absorption.is_black();
  // A thin sheet has equal sides and reflects as a plate of its own index.
  b.eta = in.is_front || b.is_thin ? ior : 1 / ior;
  if (!b.is_smooth && b.is_thin) b.near = b.far = b.one;
  if (!b.is_smooth && !b.is_thin) {
    const GlassTables& glass = in.tables.glass(in.prepared.glass);
    b.near = (in.is_front ? glass.outside : glass.inside).row(b.alpha);
    b.far = (in.is_front ? glass.inside : glass.outside).row(b.alpha);
    if (const FilmGlassTable* film = film_glass_of(b, in)) {
      b.near = (in.is_front ? film->outside : film->inside).row();
      b.far = (in.is_front ? film->inside : film->outside).row();
    }
  }
  add_glass_compensation(b, in, tint);
}

void set_reflected_share(Bsdf& b, const Inputs& in) {
  b.reflected_share = safe01(evaluate(in.textures, in.material.specular_color, in.uv));
}

void set_conductor(Bsdf& b, const Inputs& in) {
  set_clear_coat(b, in);
  set_roughness(b, in, true);
  b.fresnel = Bsdf::Fresnel::conductor;
  Rgb average = in.prepared.conductor_average;
  if (in.material.is_reflectance) {
    const Rgb r = in.base();
    b.f0 = Rgb{1};
    b.f90 = {k_from_reflectance(r.r), k_from_reflectance(r.g), k_from_reflectance(r.b)};
    if (!b.is_smooth) average = in.tables.reflectance_average(r);
  } else {
    b.f0 = safe_index(in.material.eta);
    b.f90 = safe_index(in.material.k);
    set_reflected_share(b, in);
    average *= b.reflected_share;
  }
  if (b.clear.share > 0) {  // indices relative to the coat
    b.f0 *= 1 / b.clear.bend;
    b.f90 *= 1 / b.clear.bend;
    average = safe01(metal_mean(b.f0, b.f90)) * b.reflected_share;
  }
  add_metal_compensation(b, in, average, 1);
}

void set_dielectric(Bsdf& b, const Inputs& in) {
  b.is_within = !in.is_front && !is_sheet(in);
  set_clear_coat(b, in);
  set_roughness(b, in);
  // An interface between equal indices neither refracts nor scatters.
  b.is_smooth |= std::abs(in.prepared.ior - 1) < index_matched;
  set_reflected_share(b, in);
  add_glass(b, in, 1, Rgb{1}, in.base());
  b.glass_reflect = b.reflected_share;  // the rest is absorbed, not transmitted
}

void set_coated_diffuse(Bsdf& b, const Inputs& in) {
  set_clear_coat(b, in);
  set_roughness(b, in);
  const float ior = in.prepared.ior;
  set_reflected_share(b, in);
  b.fresnel = Bsdf::Fresnel::coat;
  b.eta = ior;
  float average = in.prepared.dielectric_average;
  b.coat = Bsdf::Coat::smooth_dielectric;
  if (!b.is_smooth) {
    b.coat = Bsdf::Coat::dielectric;
    if (in.prepared.rough_coat >= 0) {
      const RoughCoatTable& table = in.tables.rough_coat(in.prepared.rough_coat);
      b.coat_row = table.held_back_row();
      b.coat_gloss = table.reflected_row();
    } else {
      b.coat_row = b.coat_gloss = in.tables.coat(in.prepared.coat).reflected.row(b.alpha);
    }
    average = b.coat_row.average;
  }
  b.diffuse_mean = 1 - average;
  const float from_below = in.prepared.rough_coat >= 0 && !b.is_smooth
                               ? in.tables.rough_coat(in.prepared.rough_coat).reflected_inside
                               : 1 - b.diffuse_mean / (ior * ior);
  const Rgb rho = in.base();
  b.diffuse = rho / ((Rgb{1} - rho * from_below) * (ior * ior));
  if (b.clear.share > 0) {
    const float mean = mean_coat_gain(b);
    b.diffuse *= b.diffuse_mean / mean;
    b.diffuse_mean = mean;
  }
  b.has_separable = !b.diffuse.is_black();
}

// Returns the f0 of a Schlick curve with this f90 that bounds the reflectance of the filmed coat
// from above, at the cosines tested.
float schlick_bound_of_film(const Bsdf& b, float f0, float f90) {
  float least = f0;
  for (const float c : {1.0f, 0.85f, 0.7f, 0.55f, 0.4f, 0.25f, 0.1f}) {
    const float film = max_component(film_reflectance(b.film, b.film.coat_f0, c)) * f90;
    const float grazing = pow5(1 - c);
    const float wanted = lerp(f0 + (f90 - f0) * grazing, film, b.film.share);
    least = std::max(least, (wanted - f90 * grazing) / (1 - grazing));
  }
  return std::min(least, f90);
}

// Sets the film over the metal and the coat, each with its reflectance and share of the surface.
// add_glass covers the glass.
void set_film(Bsdf& b, const Inputs& in, Rgb metal_f0, float metal, Rgb coat_f0, float coat) {
  const Material& m = in.material;
  if (!(m.iridescence.value > 0)) return;
  b.film =
      film_of(m, in.value(m.iridescence), in.value(m.film_thickness), in.tables.interference());
  b.film.metal_f0 = metal_f0;
  b.film.coat_f0 = coat_f0;
  b.film.metal = metal;
  b.film.coat = coat;
}

// Returns the metal's mean reflectance, film included.
Rgb metal_average(const Bsdf& b, Rgb f0) {
  const Rgb plain = f0 + (Rgb{1} - f0) * (1.0f / 21);
  if (!(b.film.share > 0)) return plain;
  Rgb sum{0};
  // medians of equal parts of the irradiance
  for (const float c : {0.408248f, 0.707107f, 0.912871f})
    sum += film_reflectance(b.film, f0, c) * (1.0f / 3);
  return plain + (sum - plain) * b.film.share;
}

// Call before the layers below are set: their means depend on the sheen.
void cover_with_sheen(Bsdf& b, const Inputs& in) {
  const Rgb color = safe01(evaluate(in.textures, in.material.sheen_color, in.uv));
  const float alpha = std::max(sqr(in.value(in.material.sheen_roughness)), least_sheen_alpha);
  if (color.is_black()) return;
  b.cover = {max_component(color), !b.is_within, in.tables.sheen().row(alpha), color, alpha};
  b.has_separable |= b.cover.is_shown;
}

void set_metallic_roughness(Bsdf& b, const Inputs& in) {
  const Material& m = in.material;
  const Rgb base = in.base();
  const float metallic = in.value(m.metallic), specular = in.value(m.specular);
  const float transmission = in.value(m.transmission);
  const float glass = (1 - metallic) * transmission;
  const float opaque = (1 - metallic) * (1 - transmission);
  const Rgb tint = evaluate(in.textures, m.specular_color, in.uv);
  // KHR_materials_ior: 0 stands for an index that reflects everything.
  const float r0 = m.ior == 0 ? 1.0f : normal_reflectance(in.prepared.ior);
  const Rgb coat_f0 = safe01(tint * r0) * specular;

  const bool is_covered = has_sheen(m);
  b.is_within = glass > 0 && !in.is_front && !is_sheet(in);
  set_clear_coat(b, in);
  if (is_covered) cover_with_sheen(b, in);
  const Passing passes = passing(in);
  if (metallic == 0 && glass == 0 && specular == 0 && !is_covered && !(b.clear.share > 0)) {
    b.through = passes.through;
    return set_lambertian(b, base * (1 - passes.share));
  }
  set_roughness(b, in, glass == 0);
  b.fresnel = Bsdf::Fresnel::schlick;
  b.f0 = base * metallic + coat_f0 * opaque;
  b.f90 = Rgb{metallic + specular * opaque};
  set_film(b, in, base, metallic, safe01(tint * r0), specular * opaque);
  add_metal_compensation(b, in, metal_average(b, base), metallic);
  if (opaque > 0) {
    b.coat_f0 = max_component(coat_f0);
    b.coat_f90 = specular;
    if (b.film.share > 0) b.coat_f0 = schlick_bound_of_film(b, b.coat_f0, specular);
    float average = b.coat_f0 + (b.coat_f90 - b.coat_f0) / 21;
    b.coat = Bsdf::Coat::smooth_schlick;
    if (!b.is_smooth) {
      b.coat = Bsdf::Coat::schlick;
      average = b.coat_f0 * (b.one.average - b.grazing.average) + b.coat_f90 * b.grazing.average;
    }
    b.diffuse_mean = 1 - average;
    if (is_covered || b.clear.share > 0) b.diffuse_mean = mean_coat_gain(b);
    if (b.diffuse_mean > negligible) {
      b.diffuse = base * ((1 - passes.share) * opaque / b.diffuse_mean);
      b.through = passes.through * (opaque / b.diffuse_mean);
    }
    b.has_separable |= !b.diffuse.is_black();
  }
  if (glass > 0) add_glass(b, in, glass, safe01(tint * specular), base);
}

void set_angular(Bsdf& b, const Inputs& in) {
  b.angular = &in.tables.angular(in.prepared.angular);
  b.has_separable = b.has_transmission = b.is_thin = true;
  b.is_back = !in.is_front;
  b.is_pane = in.prepared.is_pane;
  b.grain = in.uv.grain;
}

}  // namespace

Bsdf make_bsdf(const BsdfTables& tables, const std::vector<Material>& materials,
               const std::vector<Texture>& textures, uint32_t material, const TexturePlace& uv,
               bool is_front) {
  const Inputs in{tables, textures, materials[material], tables.material(material), uv, is_front};
  Bsdf b;
  // A ray that hits a blended surface has already met its opaque part.
  b.is_pane = in.prepared.is_pane && is_pane(in.material);
  if (!is_front && in.material.back_faces == BackFaces::black) {
    set_lambertian(b, Rgb{0});
    return b;
  }
  switch (in.material.kind) {
    case MaterialKind::diffuse:
      set_diffuse(b, in);
      break;
    case MaterialKind::coated_diffuse:
      set_coated_diffuse(b, in);
      break;
    case MaterialKind::conductor:
      set_conductor(b, in);
      break;
    case MaterialKind::dielectric:
      set_dielectric(b, in);
      break;
    case MaterialKind::metallic_roughness:
      set_metallic_roughness(b, in);
      break;
    case MaterialKind::angular:
      set_angular(b, in);
      break;
  }
  return b;
}

Bsdf make_bsdf(const BsdfTables& tables, const Scene& scene, uint32_t material,
               const TexturePlace& uv, bool is_front) {
  return make_bsdf(tables, scene.materials, scene.textures, material, uv, is_front);
}

}  // namespace troffer
