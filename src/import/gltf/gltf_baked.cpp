#include "import/gltf/gltf_baked.h"

#include "base/units.h"
#include "import/gltf/gltf_texture.h"

namespace troffer {

namespace {

// Returns a number that `troffer bake` writes to asset.extras, or `fallback`.
double note_of(const JsonNode& root, const char* group, const char* name, double fallback) {
  const auto asset = root.find("asset");
  const auto extras = asset ? asset->find("extras") : std::nullopt;
  const auto notes = extras && extras->is_object() ? extras->find(group) : std::nullopt;
  return notes && notes->is_object() ? notes->number_or(name, fallback) : fallback;
}

}  // namespace

int32_t GltfBaked::product(int32_t a, int32_t b) {
  if (a < 0 || b < 0) return a < 0 ? b : a;
  Texture both;
  both.name = "baked light on an image";
  both.kind = TextureKind::product;
  both.factor_a = uint32_t(a);
  both.factor_b = uint32_t(b);
  scene_.textures.push_back(std::move(both));
  return int32_t(scene_.textures.size() - 1);
}

void GltfBaked::emit(Rgb radiance, int32_t texture, GltfMaterial& material) {
  ++shown_;
  Material& m = scene_.materials[material.material];
  material.emission = radiance;
  material.emission_texture = texture;
  Material black;
  black.name = m.name;
  black.base_color = {Rgb{0}, no_texture};
  black.back_faces = m.back_faces;
  black.is_alpha_masked = m.is_alpha_masked;
  black.is_alpha_blended = m.is_alpha_blended;
  black.alpha = m.alpha;
  black.alpha_cutoff = m.alpha_cutoff;
  m = std::move(black);
}

// Adds the lightmap's set to the material's two sets. If both are taken, warns and uses the first.
void GltfBaked::choose_set(int set, const JsonNode& node, GltfMaterial& material) {
  GltfUvSets& sets = material.uv_sets;
  if (!material.is_textured)
    sets = {set, -1};
  else if (set != sets.first && sets.second < 0)
    sets.second = set;
  else if (set != sets.first && set != sets.second)
    scene_.warnings.add(
        node.pointer() +
        ": its lightmap uses a third set of texture coordinates; the first set is used instead");
  material.is_textured = true;
}

void GltfBaked::apply(const JsonNode& node, GltfMaterial& material, TextureLoader& loader) {
  const auto map = node.extension("MOZ_lightmap");
  const bool is_unlit = node.extension("KHR_materials_unlit").has_value();
  if (!is_shown_) {
    if (map)
      scene_.warnings.add(
          "the file holds baked light (MOZ_lightmap), which is not shown: light is computed from "
          "its sources (--baked shows it)");
    return;
  }
  if (!material.emission.is_black()) return;  // emitters show their own light
  const Material m = scene_.materials[material.material];
  if (is_unlit) {
    const double white = note_of(root_, "unlit", "white_cd_per_m2", 1);
    emit(m.base_color.value * float(white), m.base_color.texture, material);
    return;
  }
  if (!map) return;
  choose_set(gltf_uv_set(*map), node, material);
  const auto light = gltf_texture(root_, *map, true, material.uv_sets, buffers_, loader, scene_);
  const double intensity = map->number_or("intensity", 1);
  if (!(intensity >= 0)) map->member("intensity").fail("must not be negative");
  const float diffuse = (m.metallic.texture < 0 ? 1 - m.metallic.value : 1.0f) *
                        (m.transmission.texture < 0 ? 1 - m.transmission.value : 1.0f);
  const Rgb sent = m.base_color.value * light.stand_in * (diffuse * float(intensity) * inv_pi_f);
  emit(sent, product(m.base_color.texture, light.texture), material);
}

void GltfBaked::finish() const {
  if (is_shown_ && shown_ == 0)
    scene_.warnings.add("--baked: the file holds no baked light; light is computed");
}

}  // namespace troffer
