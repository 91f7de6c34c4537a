#include "bsdf/bsdf.h"

#include <algorithm>
#include <cmath>

#include "bsdf/choice.h"
#include "bsdf/coated_glass.h"
#include "bsdf/facet_lobe.h"
#include "bsdf/fresnel.h"
#include "bsdf/gains.h"
#include "bsdf/ggx.h"
#include "bsdf/lobes.h"
#include "bsdf/split.h"

namespace troffer {

namespace {

// Draws a direction from the separable lobes, chosen by u_lobe in [0,1).
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

// Returns the share of gloss in direction w that the clear coat passes.
float coat_pass(const Bsdf& b, const Vec3& w) {
  return b.clear.gloss_pass(b.clear.has_normal ? dot(w, b.clear.normal) : w.z);
}

// Convert between the viewer's frame and the frame whose x axis is the grain.
Vec3 to_grain(const Bsdf& b, const Vec3& w) {
  return {b.grain.x * w.x + b.grain.y * w.y, b.grain.x * w.y - b.grain.y * w.x, w.z};
}
Vec3 from_grain(const Bsdf& b, const Vec3& w) {
  return {b.grain.x * w.x - b.grain.y * w.y, b.grain.x * w.y + b.grain.y * w.x, w.z};
}

// Only lobes that reflect and do not transmit may skip normals that send light below the horizon.
float bound_of(const Bsdf& b, const Vec3& wo) {
  return b.has_transmission ? 1.0f : ggx_bound(wo, b.alpha);
}

// Returns pi f of the sheen below a clear coat.
Rgb sheen(const Bsdf& b, const Vec3& wo, const Vec3& wi, const Gains& at_o, const Gains& at_i) {
  return b.cover.colour * (pi_f * sheen_value(wo, wi, b.cover.alpha)) *
         std::min(at_o.coat, at_i.coat);
}

// Returns f cos of the sheen, the soft lobe and the separable lobes towards wi; wi.z > 0 is the
// viewer's side.
Rgb separable(const Bsdf& b, const Gains& at_o, const Vec3& wo, const Vec3& wi) {
  const float cos_i = wi.z;
  if (cos_i > 0) {
    const Gains at_i = gains_at(b, wi);
    Rgb sum = b.diffuse * (at_o.diffuse * at_i.diffuse) + soft_value(b.soft, at_o.soft, at_i.soft);
    if (b.cover.has_lobe()) sum += sheen(b, wo, wi, at_o, at_i);
    return (sum + b.glass_lost_reflected * (at_o.glass * at_i.glass)) * (cos_i * inv_pi_f);
  }
  if (b.glass_lost_transmitted.is_black()) return Rgb{0};
  const float far = far_glass_gain(b, -cos_i);
  const float radiance_scale = b.is_thin ? 1.0f : 1 / (b.eta * b.eta);
  return b.glass_lost_transmitted * (at_o.glass * far * -cos_i * inv_pi_f * radiance_scale);
}

// Glossy reflection, or transmission through a thin sheet with wi mirrored to the viewer's side.
// `pass` is the share of gloss that the clear coat passes; coated glass computes its own for
// reflection.
BsdfValue glossy_mirrored(const Bsdf& b, const Vec3& wo, const Vec3& wi, bool is_transmission,
                          float pass = 1) {
  const Vec3 h = wo + wi;
  const float len2 = length_squared(h);
  if (!(len2 > 1e-20f)) return {};
  const Vec3 m = h * (1 / std::sqrt(len2));
  const float c = std::min(dot(wo, m), 1.0f);
  if (!(c > 0)) return {};
  Split s = facet_split(b, c);
  const float reflected = s.reflection_share();
  if (is_coated_glass(b))
    s = coated_split(b, c, is_transmission ? pass : reflected_pass(b, wo, wi, m, c));
  else if (b.clear.share > 0)
    s.reflected *= b.clear.kept(pass, s.reflected);
  if (b.is_grained)  // reflects alone
    return {s.reflected * (facet_density(b, m, wo, wi) * wi.z),
            ggx_pdf_reflected(wo, m, b.widths, ggx_bound(wo, b.widths))};
  const float share = is_transmission ? 1 - reflected : reflected;
  const float f = facet_density(b, m, wo, wi) * wi.z;
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
  Split s = facet_split(b, co);
  const float share = 1 - s.reflection_share();
  if (is_coated_glass(b)) s = coated_split(b, co, crossing_pass(b, wo, wi));
  const float denominator = sqr(ci + co / b.eta);
  if (!(denominator > 0)) return {};
  const float jacobian = -ci / denominator;  // normals per solid angle of wi
  // D G2 co |ci| / (wo.z |wi.z| denominator eta²) |wi.z|, with G2 = 4 wo.z |wi.z| visibility
  const float f =
      facet_density(b, h, wo, {wi.x, wi.y, -wi.z}) * 4 * -wi.z * co * jacobian / (b.eta * b.eta);
  return {s.transmitted * f, share * ggx_pdf_reflected(wo, h, b.alpha, 1) * 4 * co * jacobian};
}

BsdfValue glossy(const Bsdf& b, const Vec3& wo, const Vec3& wi) {
  if (wi.z > 0) return glossy_mirrored(b, wo, wi, false);
  if (!b.has_transmission) return {};
  const float pass = is_coated_glass(b) ? crossing_pass(b, wo, wi) : 1.0f;
  return b.is_thin ? glossy_mirrored(b, wo, {wi.x, wi.y, -wi.z}, true, pass)
                   : glossy_refracted(b, wo, wi);
}

// The glossy lobe below a clear coat.
BsdfValue glossy_below(const Bsdf& b, const Vec3& wo, const Vec3& wi, float pass) {
  if (b.has_transmission) return glossy(b, wo, wi);
  if (!(wi.z > 0)) return {};
  if (!(b.clear.bend > 1)) return glossy_mirrored(b, wo, wi, false, pass);
  const Vec3 in = b.clear.below(wi);
  BsdfValue v = glossy_mirrored(b, b.clear.below(wo), in, false, pass);
  const float solid_angle_factor = b.clear.solid_angle_factor(wi, in);
  v.f_cos *= solid_angle_factor;
  v.pdf *= solid_angle_factor;
  return v;
}

// The rough reflection of the clear coat itself.
BsdfValue clear_lobe(const ClearCoat& coat, const Vec3& wo, const Vec3& wi) {
  const Vec3 o = coat.to_own(wo), i = coat.to_own(wi), h = o + i;
  const float len2 = length_squared(h);
  if (!(wi.z > 0 && o.z > 0 && i.z > 0 && len2 > 1e-20f)) return {};
  const Vec3 m = h * (1 / std::sqrt(len2));
  const float c = std::clamp(dot(o, m), 0.0f, 1.0f);
  const float f = coat.share * fresnel_dielectric(c, coat.eta) * ggx_distribution(m, coat.alpha) *
                  ggx_visibility(o.z, i.z, coat.alpha) * i.z;
  return {Rgb{f}, ggx_pdf_reflected(o, m, coat.alpha, ggx_bound(o, coat.alpha))};
}

BsdfValue evaluate_chosen(const Bsdf& b, const Gains& g, const Choice& choice, const Vec3& wo,
                          const Vec3& wi) {
  BsdfValue v;
  if (b.fresnel != Bsdf::Fresnel::none && !b.is_smooth) {
    v = b.clear.share > 0 ? glossy_below(b, wo, wi, std::min(g.coat_gloss, coat_pass(b, wi)))
                          : glossy(b, wo, wi);
    v.pdf *= choice.glossy;
    if (b.cover.share > 0) v.f_cos *= sheen_pass(b, wo.z, wi.z);
  }
  if (b.clear.has_rough_lobe()) {
    const BsdfValue coat = clear_lobe(b.clear, wo, wi);
    v.f_cos += coat.f_cos;
    v.pdf += choice.clear * coat.pdf;
  }
  if (b.has_separable) {
    v.f_cos += separable(b, g, wo, wi);
    v.pdf += separable_pdf(choice, wi.z);
  }
  return v;
}

// Samples a smooth glossy lobe. `pass`: share of a mirror's light that the sheen leaves. `above`:
// reflectance of the clear coat's mirror, added to it.
bool sample_smooth(const Bsdf& b, const Vec3& wo, float probability, float pass, float above,
                   float u_side, BsdfSample& out) {
  Split s = facet_split(b, std::min(wo.z, 1.0f));
  if (above > 0) s.reflected += Rgb{above / std::max(pass, 1e-6f)};
  const float share = s.reflection_share();
  out.is_delta = true;
  if (u_side < share) {
    out.wi = {-wo.x, -wo.y, wo.z};
    out.weight = s.reflected * (pass / (probability * share));
    return !out.weight.is_black();
  }
  out.is_transmission = true;
  out.weight = s.transmitted * (1 / (probability * (1 - share)));
  if (b.is_thin) {
    out.wi = -wo;
  } else {
    if (!refract(wo, {0, 0, 1}, wo.z, b.eta, out.wi)) return false;
    out.eta = b.eta;
    out.weight *= 1 / (b.eta * b.eta);
  }
  if (b.cover.share > 0) out.weight *= sheen_pass(b, wo.z, out.wi.z);
  return out.wi.z < 0 && !out.weight.is_black();
}

// Returns the mirror reflectance of the glossy lobe at a cosine, below its covers.
Rgb mirror_below(const Bsdf& b, const Gains& g, float c) {
  if (is_coated_glass(b)) return facet_split(b, c).reflected * g.pass;
  const float in = b.clear.share > 0 ? b.clear.cosine_below(c) : c;
  const Rgb r = split_at(b, in).reflected;
  return r * b.clear.kept(g.coat_gloss, r) * g.pass;
}

// True if the clear coat's mirror and the mirror below it send light the same way.
bool are_one_mirror(const Bsdf& b) {
  return b.clear.has_mirror() && b.is_smooth && !b.clear.has_normal;
}

// Samples the mirror of the clear coat or the mirror below it, or both if they coincide. Not for
// mirrors of coated glass.
bool sample_mirrors(const Bsdf& b, const Vec3& wo, const Gains& g, const Choice& choice,
                    bool is_clear, BsdfSample& out) {
  const bool are_one = are_one_mirror(b);
  const bool has_own_way = is_clear && b.clear.has_normal;
  const Vec3 o = has_own_way ? b.clear.to_own(wo) : wo, i{-o.x, -o.y, o.z};
  if (!(o.z > 0)) return false;
  if (are_one || !is_clear) out.weight += mirror_below(b, g, std::min(wo.z, 1.0f));
  if (are_one || is_clear) out.weight += Rgb{1 - g.coat};
  const float probability = are_one    ? choice.clear + choice.glossy
                            : is_clear ? choice.clear
                                       : choice.glossy;
  out.weight *= 1 / probability;
  out.is_delta = true;
  out.wi = has_own_way ? b.clear.from_own(i) : i;
  return out.wi.z > 0 && !out.weight.is_black();
}

bool sample_clear_rough(const Bsdf& b, const Vec3& wo, const Vec2& u, Vec3& wi) {
  const Vec3 o = b.clear.to_own(wo);
  if (!(o.z > 0)) return false;
  const Vec3 m = ggx_sample_visible_normal(o, u, b.clear.alpha, ggx_bound(o, b.clear.alpha));
  const Vec3 i = normalize(m * (2 * dot(o, m)) - o);
  wi = b.clear.from_own(i);
  return i.z > 0 && wi.z > 0;
}

// Samples a direction of the rough glossy lobe.
bool sample_rough(const Bsdf& b, const Vec3& viewer, float u_side, const Vec2& u, Vec3& wi) {
  const bool is_bent = b.clear.share > 0 && b.clear.bend > 1;
  const Vec3 wo = is_bent ? b.clear.below(viewer) : viewer;
  const Vec3 m = b.is_grained ? ggx_sample_visible_normal(wo, u, b.widths, ggx_bound(wo, b.widths))
                              : ggx_sample_visible_normal(wo, u, b.alpha, bound_of(b, wo));
  const float c = std::min(dot(wo, m), 1.0f);
  if (!(c > 0)) return false;
  const bool is_reflection = !b.has_transmission || u_side < facet_split(b, c).reflection_share();
  if (is_reflection || b.is_thin) {
    wi = normalize(m * (2 * c) - wo);
    if (!(wi.z > 0)) return false;
    if (!is_reflection) wi.z = -wi.z;
    return !is_bent || b.clear.above(wi, wi);
  }
  return refract(wo, m, c, b.eta, wi) && wi.z < 0;
}

// Direction of the viewer's frame in the frame of an angular lobe.
Vec3 to_layer(const Bsdf& b, const Vec3& w) {
  const Vec3 f = b.is_back ? Vec3{w.x, -w.y, -w.z} : w;  // front's frame
  return {b.grain.y * f.x - b.grain.x * f.y, b.grain.x * f.x + b.grain.y * f.y, f.z};
}
Vec3 from_layer(const Bsdf& b, const Vec3& w) {
  const Vec3 f{b.grain.y * w.x + b.grain.x * w.y, b.grain.y * w.y - b.grain.x * w.x, w.z};
  return b.is_back ? Vec3{f.x, -f.y, -f.z} : f;
}

BsdfValue evaluate_angular(const Bsdf& b, const Vec3& wo, const Vec3& wi) {
  if (!(wo.z > 0) || wi.z == 0 || !(std::abs(wi.z) <= 2)) return {};
  const Vec3 o = to_layer(b, wo);
  const float f_cos = b.angular->value(o, to_layer(b, wi)) * std::abs(wi.z);
  const float all = b.angular->albedo(o);
  return all > 0 ? BsdfValue{Rgb{f_cos}, f_cos / all} : BsdfValue{};
}

bool sample_angular(const Bsdf& b, const Vec3& wo, float u_lobe, const Vec2& u, BsdfSample& out) {
  const Vec3 o = to_layer(b, wo);
  Vec3 wi;
  if (!b.angular->sample(o, u_lobe, u, wi, out.is_delta)) return false;
  const float all = b.angular->albedo(o);
  out.wi = out.is_delta ? -wo : from_layer(b, wi);
  out.is_transmission = out.wi.z < 0;
  out.weight = Rgb{all};
  if (!out.is_delta) out.pdf = b.angular->value(o, wi) * std::abs(wi.z) / all;
  return out.is_delta || out.pdf > 0;
}

}  // namespace

namespace {

BsdfValue evaluate_seen(const Bsdf& b, const Vec3& wo, const Vec3& wi, bool with_pdf) {
  const Gains g = gains_of(b, wo);
  return evaluate_chosen(b, g, with_pdf ? choice_at(b, g, wo.z) : Choice{}, wo, wi);
}

}  // namespace

BsdfValue evaluate_general(const Bsdf& b, const Vec3& wo, const Vec3& wi, bool with_pdf) {
  if (b.angular != nullptr) return evaluate_angular(b, wo, wi);
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
  if (b.angular != nullptr) return sample_angular(b, viewer, u_lobe, u, out);
  const Vec3 wo = b.is_grained ? to_grain(b, viewer) : viewer;
  const Gains g = gains_of(b, wo);
  const Choice choice = choice_at(b, g, wo.z);
  const float specular = choice.clear + choice.glossy;
  if (u_lobe < specular) {
    const bool is_clear = u_lobe < choice.clear;
    const float u_side = std::min((u_lobe - choice.clear) / choice.glossy, one_minus_epsilon);
    if (is_clear ? b.clear.is_smooth : b.is_smooth) {
      if (b.has_transmission && are_one_mirror(b))
        return sample_smooth(b, wo, specular, g.pass, 1 - g.coat, u_lobe / specular, out);
      if (b.clear.share > 0 && (is_clear || !b.has_transmission)) {
        const bool is_any = sample_mirrors(b, wo, g, choice, is_clear, out);
        if (b.is_grained) out.wi = from_grain(b, out.wi);
        return is_any;
      }
      return sample_smooth(b, wo, choice.glossy, g.pass, 0, u_side, out);
    }
    if (!(is_clear ? sample_clear_rough(b, wo, u, out.wi) : sample_rough(b, wo, u_side, u, out.wi)))
      return false;
  } else {
    const float rest = (u_lobe - specular) / (1 - specular);
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

Rgb straight_transmittance(const Bsdf& b, const Vec3& wo) {
  const float cos_o = wo.z;
  if (b.angular != nullptr && cos_o > 0) return Rgb{b.angular->straight(to_layer(b, wo))};
  if (!b.is_pane || !(cos_o > 0)) return Rgb{0};
  if (!b.has_transmission) return mirrored_reflectance(b, cos_o);
  const Rgb below = facet_split(b, std::min(cos_o, 1.0f)).transmitted;
  return b.cover.share > 0 ? below * sheen_pass(b, cos_o, -cos_o) : below;
}

Rgb mirrored_reflectance(const Bsdf& b, float cos_o) {
  if (!b.is_smooth || !(cos_o > 0)) return Rgb{0};
  const float c = std::min(cos_o, 1.0f);
  const Gains g = gains_of(b, {0, 0, c});
  const float clear = b.clear.has_mirror() && !b.clear.has_normal ? 1 - g.coat : 0.0f;
  return mirror_below(b, g, c) + Rgb{clear};
}

LobeConstants lobe_constants(const Bsdf& b, float cos_o) {
  const Gains g = gains_of(b, {0, 0, cos_o});
  const Choice c = choice_at(b, g, cos_o);
  return {c.glossy, c.cosine, c.uniform, g.diffuse, g.soft};
}

Rgb albedo(const Bsdf& b, float cos_o) {
  if (b.is_lambertian) return b.diffuse + b.through;
  if (!(cos_o > 0)) return Rgb{0};
  if (b.angular != nullptr) return Rgb{b.angular->mean_albedo(!b.is_back, cos_o)};
  if (!b.through.is_black()) {
    Bsdf near = b;
    near.through = Rgb{0};
    return albedo(near, cos_o) + albedo(through_part(b), cos_o);
  }
  const float c = std::min(cos_o, 1.0f);
  const Gains g = gains_of(b, {0, 0, c});
  const Energies e = energies_at(b, g, c);
  return e.glossy + e.diffuse + e.again + e.through;
}

}  // namespace troffer
