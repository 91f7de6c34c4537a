// Parts of a Bsdf: the diffuse lobe and everything else. Covers stay over both parts.
#include "bsdf/bsdf.h"
#include "bsdf/gains.h"

namespace troffer {

Bsdf diffuse_part(const Bsdf& b) {
  Bsdf d = b;
  if (b.is_lambertian) return d;
  d.fresnel = Bsdf::Fresnel::none;
  d.has_transmission = d.is_smooth = false;
  d.angular = nullptr;
  d.soft = {};
  d.clear.is_shown = d.cover.is_shown = false;
  d.glass_lost_reflected = d.glass_lost_transmitted = Rgb{0};
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
  s.has_separable = s.angular != nullptr || s.soft.kind != SoftLobe::Kind::none ||
                    s.cover.has_lobe() || !s.glass_lost_reflected.is_black() ||
                    !s.glass_lost_transmitted.is_black();
  return s;
}

float coat_share(const Bsdf& b, float cos_i) {
  if (b.coat == Bsdf::Coat::none || !(b.diffuse_mean > 0)) return 1;
  return gains_at(b, {0, 0, cos_i}).diffuse / b.diffuse_mean;
}

}  // namespace troffer
