// Writes materials, textures and emission as glTF, each combination once. GltfWriter uses it.
// Emission is in cd/m²; material models that glTF lacks are approximated, with a warning.
#pragma once

#include <map>
#include <string>
#include <tuple>

#include "export/baked_image.h"
#include "export/baked_light.h"
#include "export/gltf_buffer.h"

namespace troffer {

// Properties of a mesh that change its material.
struct GltfPlace {
  int32_t page = -1;                   // index in BakedLight::pages
  int set = 1;                         // index of the page's texture coordinates
  bool has_light_colors = false;       // light is baked into vertex colours
  int32_t vertex_colors = no_texture;  // texture that the mesh's COLOR_0 replaces
  bool is_baked() const { return page >= 0 || has_light_colors; }
};

// Thirteen members: the scene and its options, and the tables of what the file already contains.
class GltfMaterialWriter {
 public:
  using Json = nlohmann::ordered_json;

  // All arguments must outlive the writer. `unit`: cd/m² per unit of the scene's radiance. baked:
  // may be null.
  GltfMaterialWriter(const Scene& scene, GltfBuffer& buffer, double unit, const BakedLight* baked,
                     WarningLog& warnings)
      : scene_(scene),
        buffer_(buffer),
        unit_(unit),
        baked_(baked),
        warnings_(warnings),
        mesh_uvs_(scene) {}

  // Returns the index of the material with the emission of a light (null: none) of this radiance,
  // for a mesh with the properties of `place`. Adds the material if it is new.
  size_t index_of(uint32_t material, const Light* light, Rgb radiance, const GltfPlace& place);

  // Adds "materials", "textures", "images" and "samplers" to a file.
  void finish(Json& file) const;

 private:
  const Scene& scene_;
  GltfBuffer& buffer_;
  double unit_;
  const BakedLight* baked_;
  WarningLog& warnings_;
  MaterialUvs mesh_uvs_;
  uint32_t material_ = 0;  // being written
  std::map<std::pair<uint32_t, std::string>, size_t> made_;
  std::map<std::string, size_t> texture_by_key_;
  Json materials_ = Json::array(), textures_ = Json::array(), images_ = Json::array(),
       samplers_ = Json::array();

  Json surface(const Material& m);
  void add_base(const Material& m, Json& out);
  void add_alpha(const Material& m, Json& out);
  void add_roughness(const Material& m, Json& pbr);
  void add_emission(const Light& light, Rgb radiance, Json& out);
  void add_normal(int32_t texture, float scale, const char* name, Json& out);
  void add_baked(const Material& m, const GltfPlace& place, Json& out);

  // Extensions: gltf_extensions.cpp.
  void add_glass(const Material& m, Json& out);
  void add_specular(const Material& m, Json& out);
  void add_cloth_and_grain(const Material& m, Json& out);
  void add_clear_coat(const Material& m, Json& out);
  void add_film(const Material& m, Json& out);
  void add_diffuse_transmission(const Material& m, Json& out);

  // Adds the factor and texture of this name. is_alpha: glTF reads the number from the fourth
  // channel.
  void add_number(const FloatInput& input, float power, const std::string& name, bool is_alpha,
                  Json& extension);
  void add_color(const ColorInput& input, const std::string& name, Json& extension);

  // Returns a common look for all images in these textures; nothing if there are none.
  std::optional<Texture> look_of_all(std::span<const int32_t> textures);
  // Returns a reference to the texture with this key and look; `bake` makes it if it is new.
  Json texture(const std::string& key, const Texture& look,
               const std::function<BakedImage(const Texture&)>& bake);
  size_t add_texture(std::vector<uint8_t> png, const Texture& look, const std::string& name);
  size_t page_texture(int32_t page);
};

}  // namespace troffer
