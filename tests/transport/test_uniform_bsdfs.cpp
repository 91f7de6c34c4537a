// UniformBsdfs holds the BSDFs that make_bsdf() makes at every hit.
#include "transport/uniform_bsdfs.h"

#include <doctest/doctest.h>

#include "support/scenes.h"
#include "support/textures.h"
#include "transport/prepared_scene.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("uniform materials are cached, textured ones are not") {
  Scene s;
  s.textures.push_back(grey_image(2, 2, [](int, int) { return 0.5f; }));
  const auto add = [&](MaterialKind kind, const auto& change) {
    Material m;
    m.kind = kind;
    m.base_color.value = {0.7f, 0.4f, 0.2f};
    m.roughness.value = 0.3f;
    change(m);
    return add_material(s, m);
  };
  const auto as_it_is = [](Material&) {};
  std::vector<uint32_t> even, uneven;
  for (const MaterialKind kind :
       {MaterialKind::diffuse, MaterialKind::coated_diffuse, MaterialKind::conductor,
        MaterialKind::dielectric, MaterialKind::metallic_roughness})
    even.push_back(add(kind, as_it_is));
  const MaterialKind gltf = MaterialKind::metallic_roughness;
  even.push_back(add(gltf, [](Material& m) { m.coat.value = 1; }));
  even.push_back(add(gltf, [](Material& m) { m.back_faces = BackFaces::black; }));
  uneven.push_back(add(gltf, [](Material& m) { m.base_color.texture = 0; }));
  uneven.push_back(add(gltf, [](Material& m) { m.roughness.texture = 0; }));
  uneven.push_back(add(gltf, [](Material& m) { m.anisotropy.value = 0.5f; }));
  uneven.push_back(add(gltf, [](Material& m) { m.diffuse_transmission.value = 0.5f; }));
  uneven.push_back(add(gltf, [](Material& m) {
    m.coat.value = 1;
    m.has_coat_normal = true;
    m.normal_texture = 0;
  }));
  add_quad(s, 0, {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const PreparedScene scene(std::move(s));
  const UniformBsdfs& kept = scene.uniform_bsdfs;
  for (const uint32_t m : uneven) {
    CAPTURE(m);
    CHECK(kept.find(m, true) == nullptr);
  }
  CHECK(kept.find(uint32_t(scene.scene.materials.size()), true) == nullptr);
  for (const uint32_t m : even)
    for (const bool is_front : {true, false}) {
      CAPTURE(m);
      CAPTURE(is_front);
      const SurfaceScattering* found = kept.find(m, is_front);
      REQUIRE(found != nullptr);
      TexturePlace place(Vec2{0.3f, 0.8f});
      place.grain = {0.6f, 0.8f};
      place.coat_normal = {0.1f, 0.2f};
      const SurfaceScattering made(make_bsdf(scene.bsdf_tables, scene.scene, m, place, is_front));
      CHECK(found->is_lambertian == made.is_lambertian);
      CHECK(found->has_diffuse == made.has_diffuse);
      CHECK(found->has_rough == made.has_rough);
      const Vec3 wo = normalize(Vec3{0.3f, 0.2f, 0.7f}), wi = normalize(Vec3{-0.4f, 0.1f, 0.6f});
      for (const Bsdf SurfaceScattering::*part :
           {&SurfaceScattering::whole, &SurfaceScattering::diffuse, &SurfaceScattering::specular}) {
        const BsdfValue a = evaluate_with_pdf(found->*part, wo, wi),
                        b = evaluate_with_pdf(made.*part, wo, wi);
        CHECK(a.f_cos.r == b.f_cos.r);
        CHECK(a.f_cos.b == b.f_cos.b);
        CHECK(a.pdf == b.pdf);
        CHECK(albedo(found->*part, wo.z).g == albedo(made.*part, wo.z).g);
      }
    }
}
