// Materials for tests, and integrals over their scattering by sampling.
#pragma once

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "bsdf/bsdf.h"

namespace troffer::test {

using NamedMaterials = std::vector<std::pair<std::string, Material>>;

// Materials with their tables. Bsdfs point into the tables, so this must outlive them. Tables take
// long to build, and materials of equal index share them: one set of many specimens costs less than
// many sets.
struct Specimens {
  std::vector<std::string> names;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  BsdfTables tables;

  explicit Specimens(const std::vector<Material>& m) : materials(m), tables(materials) {}
  explicit Specimens(const NamedMaterials& list)
      : names(names_of(list)), materials(materials_of(list)), tables(materials) {}
  Specimens(std::initializer_list<std::pair<std::string, Material>> list)
      : Specimens(NamedMaterials(list)) {}
  Bsdf at(size_t i, bool is_front = true) const {
    TexturePlace place(Vec2{0.5f, 0.5f});
    place.grain = {std::cos(0.4f), std::sin(0.4f)};
    return make_bsdf(tables, materials, textures, uint32_t(i), place, is_front);
  }
  size_t size() const { return materials.size(); }

 private:
  static std::vector<std::string> names_of(const NamedMaterials& list) {
    std::vector<std::string> v;
    for (const auto& [name, m] : list) v.push_back(name);
    return v;
  }
  static std::vector<Material> materials_of(const NamedMaterials& list) {
    std::vector<Material> v;
    for (const auto& [name, m] : list) v.push_back(m);
    return v;
  }
};

inline Material material_of(MaterialKind kind, float alpha, Rgb base = Rgb{1}) {
  Material m;
  m.kind = kind;
  m.roughness.value = alpha;
  m.base_color.value = base;
  return m;
}
inline Material mirror_metal(float alpha, Rgb base = Rgb{1}) {
  Material m = material_of(MaterialKind::conductor, alpha, base);
  m.is_reflectance = true;
  return m;
}
inline Material copper(float alpha) {
  Material m = material_of(MaterialKind::conductor, alpha);
  m.eta = {0.20f, 0.92f, 1.10f};
  m.k = {3.91f, 2.45f, 2.14f};
  return m;
}
inline Material coated(float alpha, Rgb base = Rgb{1}, float ior = 1.5f) {
  Material m = material_of(MaterialKind::coated_diffuse, alpha, base);
  m.ior = ior;
  return m;
}
inline Material glass(float alpha, float ior = 1.5f, bool is_thin = false) {
  Material m = material_of(MaterialKind::dielectric, alpha);
  m.ior = ior;
  m.is_thin = is_thin;
  return m;
}
inline Material gltf(float alpha, float metallic, Rgb base = Rgb{1}, float transmission = 0,
                     bool is_thin = false) {
  Material m = material_of(MaterialKind::metallic_roughness, alpha, base);
  m.metallic.value = metallic;
  m.transmission.value = transmission;
  m.is_thin = is_thin;
  return m;
}

// Adds a grain along which gloss is wider; its direction in the surface is arbitrary.
inline Material brushed(Material m, float anisotropy) {
  m.anisotropy.value = anisotropy;
  return m;
}
// A glTF material with sheen.
inline Material cloth(float sheen_roughness, Rgb sheen, float alpha = 0.5f, Rgb base = Rgb{1}) {
  Material m = gltf(alpha, 0, base);
  m.sheen_color.value = sheen;
  m.sheen_roughness.value = sheen_roughness;
  return m;
}

// Copper whose reflectance has a colour factor.
inline Material tinted(float alpha, Rgb factor = {0.9f, 0.5f, 0.2f}) {
  Material m = copper(alpha);
  m.specular_color.value = factor;
  return m;
}
inline Material reflecting(Material m, Rgb factor) {
  m.specular_color.value = factor;
  return m;
}
// Adds sheen to glTF's metal or glass.
inline Material sheened(Material m, float sheen_roughness, Rgb sheen = Rgb{1}) {
  m.sheen_color.value = sheen;
  m.sheen_roughness.value = sheen_roughness;
  return m;
}

// Adds a clear coat; over a conductor it refracts.
inline Material clear_coated(Material m, float coat_alpha, float share = 1, float ior = 1.5f) {
  m.coat.value = share;
  m.coat_roughness.value = coat_alpha;
  m.coat_ior = ior;
  return m;
}
// Adds a thin film.
inline Material filmed(Material m, float thickness_nm, float ior = 1.3f, float share = 1) {
  m.iridescence.value = share;
  m.film_ior = ior;
  m.film_thickest_nm = thickness_nm;
  return m;
}

inline Vec3 direction(float cosine, float phi = 0.7f) {
  const float s = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return {s * std::cos(phi), s * std::sin(phi), cosine};
}

struct Scattered {
  double reflected = 0, transmitted = 0;  // green channel, without the n² of radiance
  double total() const { return reflected + transmitted; }
};

// Returns the energy scattered from wo, by n quasi-random samples.
inline Scattered scattered(const Bsdf& b, const Vec3& wo, uint32_t n = 1u << 14) {
  Scattered e;
  for (uint32_t i = 0; i < n; ++i) {
    const SobolGroup u(11, 3, i);
    BsdfSample s;
    if (!sample(b, wo, u.get(2), u.get2(0), s)) continue;
    if (s.is_transmission)
      e.transmitted += double(s.weight.g) * double(s.eta) * double(s.eta);
    else
      e.reflected += double(s.weight.g);
  }
  e.reflected /= n;
  e.transmitted /= n;
  return e;
}

}  // namespace troffer::test
