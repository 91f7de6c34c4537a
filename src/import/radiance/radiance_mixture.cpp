// Radiance's mixtures: a share of the surface is one material, the rest another (part of
// RadianceMaterials).
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "import/blend_materials.h"
#include "import/radiance/radiance_material.h"

namespace troffer {

namespace {

// Points of a low-discrepancy sequence (R3: powers of the root of x^4 = x + 1) in a box of ±10.
Vec3d sample_point(int i) {
  constexpr double g = 1.2207440846057596;
  const auto part = [&](double step) {
    const double x = (i + 0.5) * step;
    return 20 * (x - std::floor(x)) - 10;
  };
  return {part(1 / g), part(1 / (g * g)), part(1 / (g * g * g))};
}

}  // namespace

// Share of the foreground. A function that varies is replaced by its mean.
double RadianceMaterials::foreground_share(const RadianceModifier& m) {
  RadianceFunctions function(m, 2, 1, 3, folder_);
  const double first = std::clamp(function.values({})[0], 0.0, 1.0);
  if (!function.has_used_ray()) return first;
  constexpr int samples = 2000;
  double sum = 0;
  for (int i = 0; i < samples; ++i)
    sum += std::clamp(function.values({{0, 0, -1}, {0, 0, 1}, sample_point(i)})[0], 0.0, 1.0);
  scene_.warnings.add("\"mixfunc\" varies over the surface: its mean is shown everywhere");
  return sum / samples;
}

RadianceLook RadianceMaterials::mix(const std::string& name, const RadianceModifier& m) {
  const std::vector<std::string>& strings = m.arguments.strings;
  if (strings.size() < 2) m.place.fail("a mixture needs two modifiers");
  double share = strings[0] == "void" ? 0 : 1;
  std::string why = "is not supported";
  if (m.type == "mixfunc") {
    try {
      share = foreground_share(m);
      why.clear();
    } catch (const InputError& e) {
      why = "cannot be evaluated (" + e.reason() + ")";
    }
  }
  if (!why.empty())
    scene_.warnings.add("mixture \"" + m.type + "\" " + why + ": its " +
                        (share > 0 ? "first" : "second") + " part is shown");
  if (share >= 1) return look_of(strings[0], m.place);
  if (share <= 0) return look_of(strings[1], m.place);
  const RadianceLook front = look_of(strings[0], m.place), back = look_of(strings[1], m.place);
  if (!front.is_there && !back.is_there) return front;
  const bool is_front = front.is_there && (share >= 0.5 || !back.is_there);
  RadianceLook look = is_front ? front : back;
  look.relayed = Rgb{0};
  Material material = scene_.materials[look.material];
  material.name = name;
  if (front.is_there && back.is_there) {
    look.emission = front.emission * float(share) + back.emission * float(1 - share);
    const Material& other = scene_.materials[(is_front ? back : front).material];
    const FloatInput others{float(is_front ? 1 - share : share), no_texture, 0};
    if (!blend_diffuse(scene_, material, other, others))
      scene_.warnings.add(
          "\"mixfunc\" of materials that are not diffuse is shown as the one that covers more of "
          "the surface");
  } else {  // holes
    material.is_alpha_masked = material.is_alpha_blended = true;
    material.alpha.value = float(front.is_there ? share : 1 - share);
  }
  look.material = uint32_t(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
  return look;
}

}  // namespace troffer
