// Writes materials and textures as directives of pbrt files. PbrtWriter calls begin() and use() for
// each shape. Images go to the output folder; properties that pbrt lacks are approximated, with a
// warning.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "export/baked_image.h"
#include "export/output_folder.h"
#include "export/pbrt_uvs.h"

namespace troffer {

class PbrtMaterialWriter {
 public:
  // All arguments must outlive the writer.
  PbrtMaterialWriter(const Scene& scene, OutputFolder& files, WarningLog& warnings)
      : scene_(scene), files_(files), warnings_(warnings), mesh_uvs_(scene) {}

  // Begins a material and the light on it (null: none). Returns the texture coordinates for its
  // meshes.
  const PbrtUvs& begin(uint32_t material, const Light* light);

  // Returns the directives that select the material for the following shapes: Material, and
  // textures at their first use. is_turned: PbrtUvs::is_turned() of all triangles.
  std::string use(bool is_turned);
  // Returns the Shape parameter for alpha, or nothing.
  std::string alpha();
  // True if alpha makes the surface invisible.
  bool is_nothing() const;
  // Returns file and factor of an emission image.
  std::pair<std::string, float> emission_image(const ColorInput& emission);

 private:
  const Scene& scene_;
  OutputFolder& files_;
  WarningLog& warnings_;
  MaterialUvs mesh_uvs_;
  std::map<std::pair<uint32_t, int32_t>, PbrtUvs> uvs_;  // by material and texture of the light
  uint32_t material_ = 0;                                // argument of begin()
  PbrtUvs* placing_ = nullptr;
  std::map<std::string, std::string> textures_;  // content -> name
  std::string definitions_;                      // definitions of textures, not yet written
  size_t images_ = 0, media_ = 0;

  std::string material_text(const Material& m);
  std::string medium_text(const Material& m);
  std::string mixed_text(const Material& m);
  std::string translucent_text(const Material& m, const ColorInput& base);
  std::string color(const char* parameter, const ColorInput& input, const ColorChange& change = {});
  std::string roughness(const Material& m, float power);
  std::string width(const char* parameter, const FloatInput& input, float power);
  std::string metal_text(const Material& m, const std::string& prefix);
  std::string coated_metal_text(const Material& m);
  std::string normal_map(const Material& m, bool is_turned);
  std::string displacement(const Material& m);
  template <class Bake>
  std::string texture(const std::string& key, const PbrtUvs::Placing& placing, bool is_number,
                      const Bake& bake);
};

}  // namespace troffer
