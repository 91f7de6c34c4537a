#include "import/blend_materials.h"

#include <utility>

namespace troffer {

ColorInput blend(Scene& scene, const ColorInput& first, const ColorInput& second,
                 const FloatInput& share) {
  if (first.texture < 0 && second.texture < 0 && share.texture < 0)
    return {first.value * (1 - share.value) + second.value * share.value, no_texture};
  Texture t;
  t.kind = TextureKind::mix;
  t.first = {first.value, first.texture};
  t.second = {second.value, second.texture};
  t.amount = {Rgb{share.value}, share.texture};
  scene.textures.push_back(std::move(t));
  return {Rgb{1}, int32_t(scene.textures.size()) - 1};
}

bool is_plain_diffuse(const Material& m) {
  return m.kind == MaterialKind::diffuse && !m.is_alpha_masked && m.normal_texture < 0 &&
         m.bump.texture < 0;
}

ColorInput transmitted(const Material& m) {
  ColorInput c = m.diffuse_transmission_color;
  c.value *= m.diffuse_transmission.value;
  if (c.value.is_black()) c.texture = no_texture;
  return c;
}

void set_diffuse(Material& m, const ColorInput& reflected, const ColorInput& through) {
  m.base_color = reflected;
  m.diffuse_transmission_color = through;
  m.diffuse_transmission.value = through.texture < 0 && through.value.is_black() ? 0.0f : 1.0f;
}

bool blend_diffuse(Scene& scene, Material& first, const Material& second, const FloatInput& share) {
  if (!is_plain_diffuse(first) || !is_plain_diffuse(second)) return false;
  const ColorInput a = transmitted(first), b = transmitted(second);
  const bool is_opaque = a.value.is_black() && b.value.is_black();
  const ColorInput through = is_opaque ? ColorInput{Rgb{0}, no_texture} : blend(scene, a, b, share);
  set_diffuse(first, blend(scene, first.base_color, second.base_color, share), through);
  return true;
}

float mean_of(const std::vector<Texture>& textures, const FloatInput& input) {
  constexpr int steps = 16;
  float sum = 0;
  for (int y = 0; y < steps; ++y)
    for (int x = 0; x < steps; ++x)
      sum += evaluate(textures, input, Vec2{(float(x) + 0.5f) / steps, (float(y) + 0.5f) / steps});
  return sum / (steps * steps);
}

}  // namespace troffer
