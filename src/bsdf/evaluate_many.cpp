#include "bsdf/evaluate_many.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/lobes.h"

namespace troffer {

namespace {

// Constants of a rough glossy lobe that do not depend on wi.
struct Glossy {
  float ox, oy, oz;    // wo
  float alpha, share;  // share: probability with which the lobe is sampled
  float pdf_scale;     // 1 / (2 (bound wo.z + t)), as in ggx_pdf_reflected
  float eta;           // Fresnel::coat
  Rgb f0, f90;         // schlick; conductor: eta and k
};

template <Bsdf::Fresnel fresnel>
TROFFER_ALWAYS_INLINE void add_glossy(const Glossy& constants, size_t n, const float* __restrict x,
                                      const float* __restrict y, const float* __restrict z,
                                      float* __restrict r, float* __restrict g, float* __restrict b,
                                      float* __restrict pdf) {
  const Glossy c = constants;
  const float a2 = c.alpha * c.alpha, b2 = 1 - a2;
  const float root_o = std::sqrt(a2 + b2 * c.oz * c.oz);
  for (size_t i = 0; i < n; ++i) {
    const float hx = c.ox + x[i], hy = c.oy + y[i], hz = c.oz + z[i];
    const float len2 = hx * hx + hy * hy + hz * hz;
    const float inverse = 1 / std::sqrt(std::max(len2, 1e-20f));
    const float mx = hx * inverse, my = hy * inverse, mz = hz * inverse;
    const float cosine = std::min(c.ox * mx + c.oy * my + c.oz * mz, 1.0f);
    const float t = (mx * mx + my * my) / a2 + mz * mz;
    const float distribution = 1 / (pi_f * a2 * t * t);
    const float zi = std::max(z[i], 1e-9f);
    const float visibility = 0.5f / (c.oz * std::sqrt(a2 + b2 * zi * zi) + zi * root_o);
    // one comparison of the smallest value that must be positive avoids branches
    const float seen = std::min(std::min(z[i], len2 - 1e-20f), std::min(cosine, mz));
    const float f = seen > 0 ? distribution * visibility * zi : 0.0f;
    if constexpr (fresnel == Bsdf::Fresnel::coat) {
      const float reflected = f * fresnel_dielectric(std::max(cosine, 0.0f), c.eta);
      r[i] += reflected;
      g[i] += reflected;
      b[i] += reflected;
    } else if constexpr (fresnel == Bsdf::Fresnel::conductor) {
      r[i] += f * fresnel_conductor(cosine, c.f0.r, c.f90.r);
      g[i] += f * fresnel_conductor(cosine, c.f0.g, c.f90.g);
      b[i] += f * fresnel_conductor(cosine, c.f0.b, c.f90.b);
    } else {
      const float grazing = pow5(std::max(0.0f, 1 - cosine));
      r[i] += f * (c.f0.r + (c.f90.r - c.f0.r) * grazing);
      g[i] += f * (c.f0.g + (c.f90.g - c.f0.g) * grazing);
      b[i] += f * (c.f0.b + (c.f90.b - c.f0.b) * grazing);
    }
    pdf[i] += seen > 0 ? c.share * distribution * c.pdf_scale : 0.0f;
  }
}

TROFFER_MULTIVERSION
void add_schlick(const Glossy& c, size_t n, const float* __restrict x, const float* __restrict y,
                 const float* __restrict z, float* __restrict r, float* __restrict g,
                 float* __restrict b, float* __restrict pdf) {
  add_glossy<Bsdf::Fresnel::schlick>(c, n, x, y, z, r, g, b, pdf);
}
TROFFER_MULTIVERSION
void add_coat(const Glossy& c, size_t n, const float* __restrict x, const float* __restrict y,
              const float* __restrict z, float* __restrict r, float* __restrict g,
              float* __restrict b, float* __restrict pdf) {
  add_glossy<Bsdf::Fresnel::coat>(c, n, x, y, z, r, g, b, pdf);
}
TROFFER_MULTIVERSION
void add_conductor(const Glossy& c, size_t n, const float* __restrict x, const float* __restrict y,
                   const float* __restrict z, float* __restrict r, float* __restrict g,
                   float* __restrict b, float* __restrict pdf) {
  add_glossy<Bsdf::Fresnel::conductor>(c, n, x, y, z, r, g, b, pdf);
}

// out[i] += scale × the row's albedo at cosine z[i].
TROFFER_MULTIVERSION
void add_row(const float* __restrict row, float fraction, float scale, size_t n,
             const float* __restrict z, float* __restrict out) {
  constexpr int last = int(table_cosines) - 2;
  for (size_t i = 0; i < n; ++i) {
    const float above = z[i] > 0 ? z[i] : 0.0f, cosine = above < 1 ? above : 1.0f;
    const float at = std::sqrt(std::sqrt(cosine)) * float(table_cosines - 1);
    const int below = int(at), k = below < last ? below : last;
    const float f = at - float(k);
    const float a = row[k] + (row[k + 1] - row[k]) * f;
    const int m = k + int(table_cosines);
    const float b = row[m] + (row[m + 1] - row[m]) * f;
    out[i] += scale * (a + (b - a) * fraction);
  }
}

// gain[i] = max(0, 1 - gain[i]).
TROFFER_MULTIVERSION
void to_missing(size_t n, float* __restrict gain) {
  for (size_t i = 0; i < n; ++i) gain[i] = std::max(0.0f, 1 - gain[i]);
}

// Adds colour × gain × cosine / pi.
TROFFER_MULTIVERSION
void add_separable(const Rgb& colour, const float* __restrict gain, size_t n,
                   const float* __restrict z, float* __restrict r, float* __restrict g,
                   float* __restrict b) {
  for (size_t i = 0; i < n; ++i) {
    const float scale = gain[i] * std::max(z[i], 0.0f) * inv_pi_f;
    r[i] += colour.r * scale;
    g[i] += colour.g * scale;
    b[i] += colour.b * scale;
  }
}

TROFFER_MULTIVERSION
void add_separable_pdf(float cosine, float uniform, size_t n, const float* __restrict z,
                       float* __restrict pdf) {
  for (size_t i = 0; i < n; ++i)
    pdf[i] += z[i] > 0 ? cosine * z[i] * inv_pi_f + uniform * (0.5f * inv_pi_f) : 0.0f;
}

constexpr size_t block = 64;

// Sets gain[i] to 1 - the reflectance of the coat over the diffuse lobe.
void diffuse_gains(const Bsdf& b, size_t n, const float* z, float* gain) {
  std::fill(gain, gain + n, 0.0f);
  switch (b.coat) {
    case Bsdf::Coat::none:
      break;
    case Bsdf::Coat::smooth_dielectric:
      for (size_t i = 0; i < n; ++i) gain[i] = fresnel_dielectric(std::max(z[i], 0.0f), b.eta);
      break;
    case Bsdf::Coat::smooth_schlick:
      for (size_t i = 0; i < n; ++i)
        gain[i] = b.coat_f0 + (b.coat_f90 - b.coat_f0) * pow5(1 - std::max(z[i], 0.0f));
      break;
    case Bsdf::Coat::dielectric:
      if (b.coat_row.values == nullptr) return;
      add_row(b.coat_row.values, b.coat_row.fraction, 1, n, z, gain);
      break;
    case Bsdf::Coat::schlick:
      add_row(b.one.values, b.one.fraction, b.coat_f0, n, z, gain);
      add_row(b.grazing.values, b.grazing.fraction, b.coat_f90 - b.coat_f0, n, z, gain);
      break;
  }
  to_missing(n, gain);
}

void add_block(const Bsdf& b, const Glossy& glossy, const LobeConstants& c, size_t n,
               const BsdfLanes& l) {
  for (float* out : {l.r, l.g, l.b, l.pdf}) std::fill(out, out + n, 0.0f);
  if (b.fresnel != Bsdf::Fresnel::none && !b.is_smooth)
    (b.fresnel == Bsdf::Fresnel::coat ? add_coat
     : b.fresnel == Bsdf::Fresnel::conductor
         ? add_conductor
         : add_schlick)(glossy, n, l.x, l.y, l.z, l.r, l.g, l.b, l.pdf);
  if (!b.has_separable) return;
  alignas(64) float gain[block];
  if (!b.diffuse.is_black()) {
    diffuse_gains(b, n, l.z, gain);
    add_separable(b.diffuse * c.diffuse_gain, gain, n, l.z, l.r, l.g, l.b);
  }
  if (b.soft.kind == SoftLobe::Kind::lost_light && b.soft.glossy.values != nullptr) {
    std::fill(gain, gain + n, 0.0f);
    add_row(b.soft.glossy.values, b.soft.glossy.fraction, 1, n, l.z, gain);
    to_missing(n, gain);
    add_separable(b.soft.colour * c.soft_gain, gain, n, l.z, l.r, l.g, l.b);
  }
  add_separable_pdf(c.cosine, c.uniform, n, l.z, l.pdf);
}

void evaluate_one_by_one(const Bsdf& b, const Vec3& wo, size_t n, const BsdfLanes& l) {
  for (size_t i = 0; i < n; ++i) {
    const BsdfValue v =
        l.z[i] > 0 ? evaluate_with_pdf(b, wo, {l.x[i], l.y[i], l.z[i]}) : BsdfValue{};
    l.r[i] = v.f_cos.r;
    l.g[i] = v.f_cos.g;
    l.b[i] = v.f_cos.b;
    l.pdf[i] = v.pdf;
  }
}

}  // namespace

void evaluate_many(const Bsdf& b, const Vec3& wo, size_t n, const BsdfLanes& l) {
  if (b.has_transmission || b.glass_weight > 0 || b.is_grained || b.cover.share > 0 ||
      b.clear.share > 0 || b.film.share > 0 || b.facets != FacetModel::balanced ||
      !is_product(b.soft) || b.reflected_share != Rgb{1})
    return evaluate_one_by_one(b, wo, n, l);
  const bool is_anything = wo.z > 0 && !is_purely_delta(b);
  const LobeConstants c = is_anything ? lobe_constants(b, wo.z) : LobeConstants{};
  Glossy glossy{wo.x, wo.y, wo.z, b.alpha, c.glossy, 0, b.eta, b.f0, b.f90};
  const float t = std::sqrt(b.alpha * b.alpha * (wo.x * wo.x + wo.y * wo.y) + wo.z * wo.z);
  glossy.pdf_scale = 1 / (2 * (ggx_bound(wo, b.alpha) * wo.z + t));
  for (size_t first = 0; first < n; first += block) {
    const size_t count = std::min(block, n - first);
    const BsdfLanes some{l.x + first, l.y + first, l.z + first,  l.r + first,
                         l.g + first, l.b + first, l.pdf + first};
    if (is_anything)
      add_block(b, glossy, c, count, some);
    else
      for (float* out : {some.r, some.g, some.b, some.pdf}) std::fill(out, out + count, 0.0f);
  }
}

}  // namespace troffer
