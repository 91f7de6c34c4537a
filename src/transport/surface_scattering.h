// A BSDF split into a diffuse and a specular part, as in [1]. Shadow rays and the general radiosity
// (or cells) illuminate the diffuse part; spawned viewing rays sample the specular part. Used by
// kj92, certified light and gather rays.
// References: [1] Kok & Jansen, Eurographics '92 (docs/method/kj92.md).
#pragma once

#include "base/units.h"
#include "bsdf/bsdf.h"

namespace troffer {

struct SurfaceScattering {
  Bsdf whole;     // the BSDF of make_bsdf()
  Bsdf diffuse;   // diffuse_part
  Bsdf specular;  // specular_part; not set if is_lambertian
  bool is_lambertian = true;
  bool has_diffuse = true;
  bool has_specular = false;  // the specular part is not empty
  bool has_rough = false;     // some of it is not a mirror, so sources are sampled for it as well

  bool is_gathered = false;  // gather_gloss() was called
  // The coat's transmittance at a few points of a source may stand for the whole source.
  bool is_low_variance = false;

  // True if light from behind is scattered through the surface.
  bool is_transmitting() const { return has_rough && specular.has_transmission; }

  explicit SurfaceScattering(const Bsdf& bsdf) : whole(bsdf) {
    is_lambertian = troffer::is_lambertian(bsdf, nullptr);
    diffuse = is_lambertian ? bsdf : diffuse_part(bsdf);
    has_diffuse = is_lambertian ? !diffuse.diffuse.is_black() : diffuse.has_separable;
    if (is_lambertian) return;
    specular = specular_part(bsdf);
    has_specular = has_glossy(specular) || specular.has_separable;
    has_rough = has_specular && !is_purely_delta(specular);
  }

  // True if the specular part is so wide that cosine-distributed directions sample it well. Their
  // second moment is about (1 + 1 / (4 alpha²)) times that of directions sampled from the lobe.
  bool is_wide() const {
    constexpr float least_width = 0.2f;
    return has_rough && !whole.has_transmission && glossy_alpha(specular) >= least_width;
  }
  // True if the lobe at this cosine is so narrow that points of sources that are chosen as for a
  // matte surface seldom fall into it.
  bool is_peaked(float cosine) const {
    constexpr float least_peak = 8;
    return 1 > least_peak * 4 * sqr(glossy_alpha(specular)) * cosine;
  }
  // Moves the specular part into `diffuse`, which becomes the whole BSDF. No ray is spawned.
  void gather_gloss() {
    is_gathered = has_diffuse = true;
    has_specular = has_rough = false;
    diffuse = whole;
  }
  // The same at a given cosine. If the lobe is peaked there, `diffuse` is unchanged, and the
  // spawned ray only looks for sources, in competition with points sampled on them.
  void gather_gloss(float cosine) {
    if (is_peaked(cosine))
      is_gathered = has_diffuse = true;
    else
      gather_gloss();
  }
};

}  // namespace troffer
