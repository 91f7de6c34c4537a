// How the 1992 method splits what a surface does with light: the diffuse part is lit by the
// general radiosity value and by shadow rays, the specular part by spawned viewing rays.
#pragma once

#include "base/units.h"
#include "bsdf/bsdf.h"

namespace troffer {

struct SurfaceScattering {
  Bsdf whole;     // as make_bsdf made it
  Bsdf diffuse;   // diffuse_part
  Bsdf specular;  // specular_part; unset where is_lambertian
  bool is_lambertian = true;
  bool has_diffuse = true;
  bool has_specular = false;  // anything to spawn viewing rays for
  bool has_rough = false;     // … of which some is not a mirror: sources are sampled for it too

  bool is_gathered = false;  // gather_gloss() was called
  // What the coat takes of a source's light may be taken for all of it as at a few of its points.
  bool is_low_variance = false;

  // Light that arrives from behind goes through, other than straight on.
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

  // Whether the specular part is so wide that directions by a cosine sample it well: their second
  // moment is about (1 + 1 / (4 alpha²)) times that of directions of its own.
  bool is_wide() const {
    constexpr float least_width = 0.2f;
    return has_rough && !whole.has_transmission && glossy_alpha(specular) >= least_width;
  }
  // Whether, seen at this cosine, it shows some directions for so much more than others that points
  // of sources, chosen as for a matte surface, seldom are where it looks.
  bool is_peaked(float cosine) const {
    constexpr float least_peak = 8;
    return 1 > least_peak * 4 * sqr(glossy_alpha(specular)) * cosine;
  }
  // No ray is spawned: what `specular` does is asked for with the diffuse part, which then is the
  // whole.
  void gather_gloss() {
    is_gathered = has_diffuse = true;
    has_specular = has_rough = false;
    diffuse = whole;
  }
  // So, seen at this cosine; but where it is peaked, `diffuse` remains what it is, and a ray is
  // spawned that looks for sources alone, in competition with points of these.
  void gather_gloss(float cosine) {
    if (is_peaked(cosine))
      is_gathered = has_diffuse = true;
    else
      gather_gloss();
  }
};

}  // namespace troffer
