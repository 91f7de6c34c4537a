// The mirror image of a scene keeps what coverage is made of.
#include <doctest/doctest.h>

#include "scene/mirror_image.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("alpha patterns keep their operands in a mirror image") {
  Scene scene;
  Texture operand;
  operand.value = Rgb{0.25f};
  scene.textures.push_back(operand);
  for (const TextureKind kind : {TextureKind::checks, TextureKind::dots, TextureKind::mix}) {
    Texture pattern;
    pattern.kind = kind;
    pattern.first.texture = pattern.second.texture = pattern.amount.texture = 0;
    scene.textures.push_back(pattern);
  }
  for (int32_t t = 1; t < 4; ++t) {
    Material m;
    m.is_alpha_masked = true;
    m.alpha = {1, t, 0};
    const uint32_t material = add_material(scene, m);
    add_quad(scene, material,
             {Vec3{-1, float(t), 0}, {1, float(t), 0}, {1, float(t), 2}, {-1, float(t), 2}});
  }
  Material metal;
  metal.kind = MaterialKind::conductor;
  FlatMirror mirror;
  mirror.normal = {0, 1, 0};
  mirror.tolerance = 1e-5f;
  mirror.outline = {{-1, 0, 0.5f}, {1, 0, 0.5f}, {1, 0, 2}, {-1, 0, 2}};
  mirror.material = add_material(scene, metal);
  const std::optional<MirrorImage> image = mirror_image_of(scene, mirror);
  REQUIRE(image.has_value());
  for (const Material& m : image->scene.materials) {
    if (!m.is_alpha_masked) continue;
    CHECK(evaluate(image->scene.textures, m.alpha, TexturePlace(Vec2{0.3f, 0.3f})) ==
          doctest::Approx(evaluate(scene.textures, m.alpha, TexturePlace(Vec2{0.3f, 0.3f}))));
  }
  CHECK(image->scene.textures[0].value == operand.value);
}
