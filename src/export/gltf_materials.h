// Materials, textures and emission -> glTF's.
#pragma once

#include <map>
#include <string>
#include <tuple>

#include "export/baked_image.h"
#include "export/baked_light.h"
#include "export/gltf_buffer.h"

namespace troffer {

// Where a surface finds its baked light.
struct BakedPlace {
  int32_t page = -1;        // of BakedLight::pages
  int set = 1;              // of texture coordinates
  bool has_colors = false;  // of vertices
  bool is_baked() const { return page >= 0 || has_colors; }
};

class GltfMaterialWriter {
 public:
  using Json = nlohmann::ordered_json;

  // All must outlive this. `unit`: cd/m² per the scene's radiance. baked: may be null.
  GltfMaterialWriter(const Scene& scene, GltfBuffer& buffer, double unit, const BakedLight* baked,
                     WarningLog& warnings)
      : scene_(scene), buffer_(buffer), unit_(unit), baked_(baked), warnings_(warnings) {}

  // Index of the material with the emission of a light (null: none), of that radiance, and the
  // light that is baked there.
  size_t index_of(uint32_t material, const Light* light, Rgb radiance, const BakedPlace& place);

  // Adds "materials", "textures", "images", "samplers" to a file.
  void finish(Json& file) const;

 private:
  const Scene& scene_;
  GltfBuffer& buffer_;
  double unit_;
  const BakedLight* baked_;
  WarningLog& warnings_;
  std::map<std::pair<uint32_t, std::string>, size_t> made_;
  std::map<std::string, size_t> texture_by_key_;
  Json materials_ = Json::array(), textures_ = Json::array(), images_ = Json::array(),
       samplers_ = Json::array();

  Json surface(const Material& m);
  void add_base(const Material& m, Json& out);
  void add_roughness(const Material& m, Json& pbr);
  void add_glass(const Material& m, Json& out);
  void add_cloth_and_grain(const Material& m, Json& out);
  void add_number(const FloatInput& input, float power, const std::string& name, Json& extension);
  void add_clear_coat(const Material& m, Json& out);
  void add_film(const Material& m, Json& out);
  void add_diffuse_transmission(const Material& m, Json& out);
  void add_emission(const Light& light, Rgb radiance, Json& out);
  size_t texture(const std::string& key, const BakedImage& image, const Texture& look);
  size_t page_texture(int32_t page);
  void add_baked(const Material& m, const BakedPlace& place, Json& out);
  Json reference(size_t texture, const Texture& look) const;
};

}  // namespace troffer
