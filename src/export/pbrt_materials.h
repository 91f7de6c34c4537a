// Materials and textures -> directives of pbrt files.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "export/baked_image.h"
#include "export/output_folder.h"

namespace troffer {

class PbrtMaterialWriter {
 public:
  // All must outlive this.
  PbrtMaterialWriter(const Scene& scene, OutputFolder& files, WarningLog& warnings)
      : scene_(scene), files_(files), warnings_(warnings) {}

  // The directives that make what follows wear that material: its textures, where they are asked
  // for the first time, and Material.
  std::string use(uint32_t material);
  // The parameter of a Shape that cuts its holes, or nothing.
  std::string alpha_of(uint32_t material);
  // File and factor of an emission's image.
  std::pair<std::string, float> emission_image(const ColorInput& emission);

 private:
  const Scene& scene_;
  OutputFolder& files_;
  WarningLog& warnings_;
  std::map<std::string, std::string> textures_;  // by what they hold -> name
  std::string definitions_;                      // of textures, not yet written
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
  std::string image_texture(const BakedImage& image, const Texture* look, bool is_number);
  std::string texture_name(const std::string& key, const BakedImage& image, const Texture* look,
                           bool is_number);
};

}  // namespace troffer
