// How the 1992 method splits what a surface does with light: the diffuse part is lit by the
// general radiosity value and by shadow rays, the specular part by spawned viewing rays.
#pragma once

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

  // Light that arrives from behind goes through, other than straight on.
  bool is_transmitting() const { return has_rough && specular.has_transmission; }

  explicit SurfaceScattering(const Bsdf& bsdf) : whole(bsdf) {
    is_lambertian = troffer::is_lambertian(bsdf, nullptr);
    diffuse = is_lambertian ? bsdf : diffuse_part(bsdf);
    has_diffuse = is_lambertian || diffuse.has_separable;
    if (is_lambertian) return;
    specular = specular_part(bsdf);
    has_specular = has_glossy(specular) || specular.has_separable;
    has_rough = has_specular && !is_purely_delta(specular);
  }
};

}  // namespace troffer
