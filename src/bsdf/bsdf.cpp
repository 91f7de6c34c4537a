#include "bsdf/bsdf.h"

#include <algorithm>
#include <cmath>

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/lobes.h"
#include "bsdf/split.h"

namespace troffer {

namespace {

// The g of each separable lobe at a direction on the viewer's side (far_glass: on the other).
struct Gains {
  float diffuse = 1, soft = 0, glass = 0;
  float pass = 1;  // of a sheen above, for all but itself; in `diffuse` already
};

float missing(const AlbedoRow& row, const CosineCoordinate& at) {
  return row.values == nullptr ? 0.0f : std::max(0.0f, 1 - row.at(at));
}

Gains gains_at(const Bsdf& b, const Vec3& w) {
  Gains g;
  const float cosine = w.z;
  const SoftDirection direction(w);
  const CosineCoordinate& at = direction.cosine;
  switch (b.coat) {
    case Bsdf::Coat::none:
      break;
    case Bsdf::Coat::smooth_dielectric:
      g.diffuse = 1 - fresnel_dielectric(cosine, b.eta);
      break;
    case Bsdf::Coat::smooth_schlick:
      g.diffuse = 1 - (b.coat_f0 + (b.coat_f90 - b.coat_f0) * pow5(1 - cosine));
      break;
    case Bsdf::Coat::dielectric:
      g.diffuse = missing(b.coat_row, at);
      break;
    case Bsdf::Coat::schlick: {
      const float one = b.one.at(at), grazing = b.grazing.at(at);
      g.diffuse = std::max(0.0f, 1 - (b.coat_f0 * (one - grazing) + b.coat_f90 * grazing));
      break;
    }
  }
  g.soft = soft_gain(b.soft, direction);
  g.pass = b.cover.pass(at);
  g.diffuse *= g.pass;
  if (b.glass_weight > 0) g.glass = missing(b.near, at);
  return g;
}

// Energy from a direction of cosine c that leaves through the glossy lobe.
Rgb glossy_albedo(const Bsdf& b, float c) {
  if (b.fresnel == Bsdf::Fresnel::none) return Rgb{0};
  if (b.is_smooth) {
    const Split s = split_at(b, c);
    return s.reflected + s.transmitted;
  }
  const CosineCoordinate at(c);
  if (b.fresnel == Bsdf::Fresnel::coat) return Rgb{b.coat_row.at(at)};
  const float grazing = b.grazing.at(at), steep = b.one.at(at) - grazing;
  // A conductor is taken as Schlick's of the same reflectance at normal incidence.
  if (b.fresnel == Bsdf::Fresnel::conductor)
    return fresnel_conductor(1, b.f0, b.f90) * steep + Rgb{grazing};
  const Rgb opaque = b.f0 * steep + b.f90 * grazing;
  if (b.fresnel == Bsdf::Fresnel::schlick) return opaque;
  // Glass loses its share as a whole; how the rest divides is taken from the mirror's.
  const Split s = split_at(b, c);
  return opaque + (s.reflected - fresnel_schlick(c, b.f0, b.f90) + s.transmitted) * b.near.at(at);
}

// Energies of the lobes: glossy, diffuse, and lost energy that returns on either side.
struct Energies {
  Rgb glossy, diffuse, again, through;
};
Energies energies_at(const Bsdf& b, const Gains& g, float cos_o) {
  Energies e;
  e.glossy = glossy_albedo(b, cos_o) * g.pass;
  if (!b.has_separable) return e;
  e.diffuse = b.diffuse * (g.diffuse * b.diffuse_mean);
  e.again = soft_energy(b.soft, g.soft) + b.glass_again * (g.glass * b.near_mean);
  e.through = b.glass_through * (g.glass * b.far_mean);
  return e;
}

// Probabilities of the ways to sample, in proportion to the energies: the glossy lobe, and
// directions with cosine or uniform density on either side. What returns of lost energy is
// uniform-like: the smoother the surface, the closer to grazing it keeps.
struct Choice {
  float glossy = 0, cosine = 0, uniform = 0, cosine_through = 0, uniform_through = 0;
};
Choice choice_at(const Bsdf& b, const Gains& g, float cos_o) {
  if (b.fresnel == Bsdf::Fresnel::none) return {0, 1, 0, 0, 0};
  if (!b.has_separable) return {1, 0, 0, 0, 0};
  const Energies e = energies_at(b, g, cos_o);
  const float glossy = average(e.glossy), diffuse = average(e.diffuse);
  const float again = average(e.again), through = average(e.through);
  const float sum = glossy + diffuse + again + through;
  if (!(sum > 0)) return {};
  const float s = 1 / sum, uniform = 1 - b.alpha;
  return {glossy * s, (diffuse + again * b.alpha) * s, again * uniform * s, through * b.alpha * s,
          through * uniform * s};
}

// Density of all ways but the glossy one.
float separable_pdf(const Choice& c, float cos_i) {
  constexpr float uniform = 0.5f * inv_pi_f;
  return cos_i > 0 ? c.cosine * cos_i * inv_pi_f + c.uniform * uniform
                   : c.cosine_through * -cos_i * inv_pi_f + c.uniform_through * uniform;
}

// u_lobe in [0,1) chooses among all ways but the glossy one.
Vec3 sample_separable(const Choice& c, float u_lobe, const Vec2& u) {
  const float sum = c.cosine + c.uniform + c.cosine_through + c.uniform_through;
  float x = u_lobe * sum;
  const bool is_through = (x -= c.cosine + c.uniform) >= 0 && c.cosine_through > 0;
  const float cosine = is_through ? c.cosine_through : c.cosine;
  if (!is_through) x += c.cosine + c.uniform;
  Vec3 w;
  if (x < cosine) {
    w = cosine_hemisphere_from_square(u);
  } else {
    w = sphere_from_square(u);
    w.z = std::abs(w.z);
  }
  if (is_through) w.z = -w.z;
  return w;
}

// Between the viewer's frame and that whose x axis is the grain.
Vec3 to_grain(const Bsdf& b, const Vec3& w) {
  return {b.grain.x * w.x + b.grain.y * w.y, b.grain.x * w.y - b.grain.y * w.x, w.z};
}
Vec3 from_grain(const Bsdf& b, const Vec3& w) {
  return {b.grain.x * w.x - b.grain.y * w.y, b.grain.x * w.y + b.grain.y * w.x, w.z};
}

// Only lobes that reflect alone can leave out the normals that send light below the horizon.
float bound_of(const Bsdf& b, const Vec3& wo) {
  return b.has_transmission ? 1.0f : ggx_bound(wo, b.alpha);
}

// The soft lobe and the cosine-shaped ones at wi; cos_i > 0 on the viewer's side.
Rgb separable(const Bsdf& b, const Gains& at_o, const Vec3& wo, const Vec3& wi) {
  const float cos_i = wi.z;
  if (cos_i > 0) {
    const Gains at_i = gains_at(b, wi);
    return (b.diffuse * (at_o.diffuse * at_i.diffuse) +
            soft_value(b.soft, wo, wi, at_o.soft, at_i.soft) +
            b.glass_again * (at_o.glass * at_i.glass)) *
           (cos_i * inv_pi_f);
  }
  if (b.glass_through.is_black()) return Rgb{0};
  const float far = missing(b.far, CosineCoordinate(-cos_i));
  const float radiance_scale = b.is_thin ? 1.0f : 1 / (b.eta * b.eta);
  return b.glass_through * (at_o.glass * far * -cos_i * inv_pi_f * radiance_scale);
}

// Glossy reflection, or transmission through a thin sheet with wi mirrored to the viewer's side.
BsdfValue glossy_mirrored(const Bsdf& b, const Vec3& wo, const Vec3& wi, bool is_transmission) {
  const Vec3 h = wo + wi;
  const float len2 = length_squared(h);
  if (!(len2 > 1e-20f)) return {};
  const Vec3 m = h * (1 / std::sqrt(len2));
  const float c = std::min(dot(wo, m), 1.0f);
  if (!(c > 0)) return {};
  const Split s = split_at(b, c);
  if (b.is_grained)  // reflects alone
    return {s.reflected * (ggx_distribution(m, b.widths) * ggx_visibility(wo, wi, b.widths) * wi.z),
            ggx_pdf_reflected(wo, m, b.widths, ggx_bound(wo, b.widths))};
  const float share = is_transmission ? 1 - s.reflection_share() : s.reflection_share();
  const float f = ggx_distribution(m, b.alpha) * ggx_visibility(wo.z, wi.z, b.alpha) * wi.z;
  return {(is_transmission ? s.transmitted : s.reflected) * f,
          share * ggx_pdf_reflected(wo, m, b.alpha, bound_of(b, wo))};
}

// Glossy refraction [3, Eq. 16, 17, 21], wi.z < 0.
BsdfValue glossy_refracted(const Bsdf& b, const Vec3& wo, const Vec3& wi) {
  Vec3 h = wo + wi * b.eta;
  const float len2 = length_squared(h);
  if (!(len2 > 1e-20f)) return {};
  h *= std::copysign(1 / std::sqrt(len2), h.z);
  const float co = std::min(dot(wo, h), 1.0f), ci = dot(wi, h);
  if (!(co > 0 && ci < 0)) return {};
  const Split s = split_at(b, co);
  const float denominator = sqr(ci + co / b.eta);
  if (!(denominator > 0)) return {};
  const float jacobian = -ci / denominator;  // normals per solid angle of wi
  // D G2 co |ci| / (wo.z |wi.z| denominator eta²) |wi.z|, with G2 = 4 wo.z |wi.z| visibility
  const float f = ggx_distribution(h, b.alpha) * 4 * ggx_visibility(wo.z, -wi.z, b.alpha) * -wi.z *
                  co * jacobian / (b.eta * b.eta);
  return {s.transmitted * f,
          (1 - s.reflection_share()) * ggx_pdf_reflected(wo, h, b.alpha, 1) * 4 * co * jacobian};
}

BsdfValue glossy(const Bsdf& b, const Vec3& wo, const Vec3& wi) {
  if (wi.z > 0) return glossy_mirrored(b, wo, wi, false);
  if (!b.has_transmission) return {};
  return b.is_thin ? glossy_mirrored(b, wo, {wi.x, wi.y, -wi.z}, true)
                   : glossy_refracted(b, wo, wi);
}

BsdfValue evaluate_chosen(const Bsdf& b, const Gains& g, const Choice& choice, const Vec3& wo,
                          const Vec3& wi) {
  BsdfValue v;
  if (b.fresnel != Bsdf::Fresnel::none && !b.is_smooth) {
    v = glossy(b, wo, wi);
    v.pdf *= choice.glossy;
    if (b.cover.share > 0)
      v.f_cos *= std::min(b.cover.pass(CosineCoordinate(wo.z)),
                          b.cover.pass(CosineCoordinate(std::abs(wi.z))));
  }
  if (b.has_separable) {
    v.f_cos += separable(b, g, wo, wi);
    v.pdf += separable_pdf(choice, wi.z);
  }
  return v;
}

// Direction of refraction at a normal m that wo sees at cosine c; false on total reflection.
bool refract(const Vec3& wo, const Vec3& m, float c, float eta, Vec3& wi) {
  const float cos_t = refracted_cosine(c, eta);
  if (cos_t < 0) return false;
  wi = normalize(m * (c / eta - cos_t) - wo * (1 / eta));
  return true;
}

// pass: what a sheen above leaves.
bool sample_smooth(const Bsdf& b, const Vec3& wo, float probability, float pass, float u_side,
                   BsdfSample& out) {
  const Split s = split_at(b, std::min(wo.z, 1.0f));
  const float share = s.reflection_share();
  out.is_delta = true;
  if (u_side < share) {
    out.wi = {-wo.x, -wo.y, wo.z};
    out.weight = s.reflected * (pass / (probability * share));
    return !out.weight.is_black();
  }
  out.is_transmission = true;
  out.weight = s.transmitted * (pass / (probability * (1 - share)));
  if (b.is_thin) {
    out.wi = -wo;
  } else {
    if (!refract(wo, {0, 0, 1}, wo.z, b.eta, out.wi)) return false;
    out.eta = b.eta;
    out.weight *= 1 / (b.eta * b.eta);
  }
  return out.wi.z < 0 && !out.weight.is_black();
}

// A direction of the rough glossy lobe.
bool sample_rough(const Bsdf& b, const Vec3& wo, float u_side, const Vec2& u, Vec3& wi) {
  const Vec3 m = b.is_grained ? ggx_sample_visible_normal(wo, u, b.widths, ggx_bound(wo, b.widths))
                              : ggx_sample_visible_normal(wo, u, b.alpha, bound_of(b, wo));
  const float c = std::min(dot(wo, m), 1.0f);
  if (!(c > 0)) return false;
  const bool is_reflection = !b.has_transmission || u_side < split_at(b, c).reflection_share();
  if (is_reflection || b.is_thin) {
    wi = normalize(m * (2 * c) - wo);
    if (!(wi.z > 0)) return false;
    if (!is_reflection) wi.z = -wi.z;
    return true;
  }
  return refract(wo, m, c, b.eta, wi) && wi.z < 0;
}

}  // namespace

namespace {

BsdfValue evaluate_seen(const Bsdf& b, const Vec3& wo, const Vec3& wi, bool with_pdf) {
  const Gains g = b.has_separable ? gains_at(b, wo) : Gains{};
  return evaluate_chosen(b, g, with_pdf ? choice_at(b, g, wo.z) : Choice{}, wo, wi);
}

}  // namespace

BsdfValue evaluate_general(const Bsdf& b, const Vec3& wo, const Vec3& wi, bool with_pdf) {
  if (!(wo.z > 0) || wi.z == 0 || !(std::abs(wi.z) <= 2)) return {};
  if (wi.z < 0 && !b.has_transmission) return {};
  if (is_purely_delta(b)) return {};
  if (b.is_grained) return evaluate_seen(b, to_grain(b, wo), to_grain(b, wi), with_pdf);
  return evaluate_seen(b, wo, wi, with_pdf);
}

bool sample_general(const Bsdf& b, const Vec3& viewer, float u_lobe, const Vec2& u,
                    BsdfSample& out) {
  out = {};
  if (!(viewer.z > 0)) return false;
  const Vec3 wo = b.is_grained ? to_grain(b, viewer) : viewer;
  const Gains g = b.has_separable ? gains_at(b, wo) : Gains{};
  const Choice choice = choice_at(b, g, wo.z);
  if (u_lobe < choice.glossy) {
    const float u_side = std::min(u_lobe / choice.glossy, one_minus_epsilon);
    if (b.is_smooth) return sample_smooth(b, wo, choice.glossy, g.pass, u_side, out);
    if (!sample_rough(b, wo, u_side, u, out.wi)) return false;
  } else {
    const float rest = (u_lobe - choice.glossy) / (1 - choice.glossy);
    out.wi = sample_separable(choice, std::min(rest, one_minus_epsilon), u);
  }
  const BsdfValue v = evaluate_chosen(b, g, choice, wo, out.wi);
  if (!(v.pdf > 0) || !std::isfinite(v.pdf) || out.wi.z == 0) return false;
  if (b.is_grained) out.wi = from_grain(b, out.wi);
  out.weight = v.f_cos / v.pdf;
  out.pdf = v.pdf;
  out.is_transmission = out.wi.z < 0;
  if (out.is_transmission && !b.is_thin) out.eta = b.eta;
  return is_finite(out.weight) && !out.weight.is_black();
}

Rgb straight_transmittance(const Bsdf& b, float cos_o) {
  if (!b.is_pane || !(cos_o > 0)) return Rgb{0};
  const Split s = split_at(b, std::min(cos_o, 1.0f));
  return b.has_transmission ? s.transmitted : s.reflected;
}

Rgb mirrored_reflectance(const Bsdf& b, float cos_o) {
  if (!b.is_smooth || !(cos_o > 0)) return Rgb{0};
  const float c = std::min(cos_o, 1.0f);
  const float pass = b.cover.pass(CosineCoordinate(c));
  return split_at(b, c).reflected * pass;
}

LobeConstants lobe_constants(const Bsdf& b, float cos_o) {
  const Gains g = b.has_separable ? gains_at(b, {0, 0, cos_o}) : Gains{};
  const Choice c = choice_at(b, g, cos_o);
  return {c.glossy, c.cosine, c.uniform, g.diffuse, g.soft};
}

Bsdf diffuse_part(const Bsdf& b) {
  Bsdf d = b;
  if (b.is_lambertian) return d;
  d.fresnel = Bsdf::Fresnel::none;
  d.has_transmission = d.is_smooth = false;
  d.soft = {};
  d.glass_again = d.glass_through = Rgb{0};
  d.glass_weight = 0;
  d.has_separable = !d.diffuse.is_black();
  return d;
}

Bsdf through_part(const Bsdf& b) {
  Bsdf d = diffuse_part(b);
  d.diffuse = b.through;
  d.through = Rgb{0};
  d.has_separable = !d.diffuse.is_black();
  return d;
}

Bsdf specular_part(const Bsdf& b) {
  Bsdf s = b;
  s.through = Rgb{0};
  s.is_lambertian = false;
  s.coat = Bsdf::Coat::none;
  s.diffuse = Rgb{0};
  s.has_separable = s.soft.kind != SoftLobe::Kind::none || !s.glass_again.is_black() ||
                    !s.glass_through.is_black();
  return s;
}

float coat_share(const Bsdf& b, float cos_i) {
  if (b.coat == Bsdf::Coat::none || !(b.diffuse_mean > 0)) return 1;
  return gains_at(b, {0, 0, cos_i}).diffuse / b.diffuse_mean;
}

Rgb albedo(const Bsdf& b, float cos_o) {
  if (b.is_lambertian) return b.diffuse + b.through;
  if (!(cos_o > 0)) return Rgb{0};
  if (!b.through.is_black()) {
    Bsdf near = b;
    near.through = Rgb{0};
    return albedo(near, cos_o) + albedo(through_part(b), cos_o);
  }
  const float c = std::min(cos_o, 1.0f);
  const Gains g = b.has_separable ? gains_at(b, {0, 0, c}) : Gains{};
  const Energies e = energies_at(b, g, c);
  return e.glossy + e.diffuse + e.again + e.through;
}

}  // namespace troffer
