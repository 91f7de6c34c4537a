// The value lists of materials and lights leave out nothing that matters.
#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <vector>

#include "scene/light.h"
#include "scene/material.h"

using namespace troffer;

namespace {

struct Collector {
  std::vector<double> values;
  void add(uint64_t v) { values.push_back(double(v)); }
  void add(float v) { values.push_back(double(v)); }
  void add(const Vec3& v) {
    for (size_t i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Rgb& v) {
    for (size_t i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const ColorInput& in) {
    add(in.value);
    add(uint64_t(in.texture + 1));
  }
  void add(const FloatInput& in) {
    add(in.value);
    add(uint64_t(in.texture + 1));
    add(uint64_t(in.channel));
  }
};

template <class T>
std::vector<double> values_of(const T& t) {
  Collector c;
  for_each_value(t, [&](const auto& v) { c.add(v); });
  return c.values;
}

}  // namespace

TEST_CASE("any change of a material that affects scattering changes its values") {
  const Material plain;
  const std::vector<std::function<void(Material&)>> changes{
      [](Material& m) { m.kind = MaterialKind::conductor; },
      [](Material& m) { m.base_color.value.g = 0.25f; },
      [](Material& m) { m.base_color.texture = 3; },
      [](Material& m) { m.roughness.value = 0.5f; },
      [](Material& m) { m.roughness.texture = 3; },
      [](Material& m) { m.roughness_meaning = RoughnessMeaning::alpha_is_square; },
      [](Material& m) { m.metallic.value = 0.5f; },
      [](Material& m) { m.metallic.channel = 1; },
      [](Material& m) { m.ior = 1.7f; },
      [](Material& m) { m.specular.value = 0.5f; },
      [](Material& m) { m.specular_color.value.b = 0.5f; },
      [](Material& m) { m.transmission.value = 0.5f; },
      [](Material& m) { m.is_thin = true; },
      [](Material& m) { m.is_reflectance = true; },
      [](Material& m) { m.eta.r = 1; },
      [](Material& m) { m.k.b = 1; },
      [](Material& m) { m.is_alpha_masked = true; },
      [](Material& m) { m.is_alpha_blended = true; },
      [](Material& m) { m.alpha.texture = 1; },
      [](Material& m) { m.alpha_cutoff = 0.75f; },
  };
  for (const auto& change : changes) {
    Material m;
    change(m);
    CHECK(values_of(m) != values_of(plain));
  }
}

TEST_CASE("any change of matrices changes a material's values") {
  const auto with = [](float value, bool is_sharp, float up) {
    AngularBsdf b;
    b.to_front = {klems_quarter(), klems_quarter(), std::vector<float>(41 * 41, 0.1f)};
    b.to_front.values[77] = value;
    Material m;
    m.kind = MaterialKind::angular;
    m.angular = std::make_shared<const AngularBsdf>(b);
    m.has_sharp_peak = is_sharp;
    m.angular_up.y = up;
    return values_of(m);
  };
  const auto plain = with(0.1f, false, 0);
  CHECK(plain == with(0.1f, false, 0));
  CHECK(plain != with(0.2f, false, 0));
  CHECK(plain != with(0.1f, true, 0));
  CHECK(plain != with(0.1f, false, 1));
}

TEST_CASE("a material is textured if one of its inputs is") {
  Material m;
  CHECK_FALSE(has_textured_input(m));
  m.alpha.texture = m.normal_texture = 0;  // masks and bumps are not inputs of scattering
  CHECK_FALSE(has_textured_input(m));
  for (FloatInput* f : {&m.roughness, &m.metallic, &m.specular, &m.transmission}) {
    f->texture = 0;
    CHECK(has_textured_input(m));
    f->texture = no_texture;
  }
  for (ColorInput* c : {&m.base_color, &m.specular_color}) {
    c->texture = 0;
    CHECK(has_textured_input(m));
    c->texture = no_texture;
  }
}

TEST_CASE("any change of a light that affects its emission changes its values") {
  for (const LightKind kind : {LightKind::polygon, LightKind::spot}) {
    Light plain;
    plain.kind = kind;
    std::vector<std::function<void(Light&)>> changes{
        [](Light& e) { e.kind = LightKind::distant; },
        [](Light& e) { e.radiance.g = 7; },
        [](Light& e) { e.texture = 2; },
        [](Light& e) { e.is_two_sided = true; },
        [](Light& e) { e.geometry = 1; },
        [](Light& e) {
          e.polygon.push_back({1, 2, 3});
        },
    };
    if (!has_surface(kind)) {
      changes.push_back([](Light& e) { e.position.x = 1; });
      changes.push_back([](Light& e) { e.direction = {1, 0, 0}; });
      changes.push_back([](Light& e) { e.cos_inner = 0.5f; });
      changes.push_back([](Light& e) { e.cos_outer = 0.5f; });
    }
    for (const auto& change : changes) {
      Light e = plain;
      change(e);
      CHECK(values_of(e) != values_of(plain));
    }
  }
}
