// Named textures of pbrt files, each made when a material first uses it. Used by PbrtMaterials.
// Directives only store a texture's parameters.
//
// References: [1] pbrt-v4 Input File Format, section "Textures", pbrt.org/fileformat-v4.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "import/pbrt/pbrt_params.h"
#include "import/pbrt/pbrt_spectrum.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

class PbrtTextures {
 public:
  // Files are looked up in `folder` and never outside. The scene must outlive this object.
  PbrtTextures(Scene& scene, std::string folder)
      : scene_(scene), folder_(std::move(folder)), loader_(scene) {}

  // Defines a texture by a Texture directive. It replaces an existing one of that name, with a
  // warning. `world_from_texture` is the space of textures that depend on position.
  void define(const std::string& name, bool is_float, const std::string& kind, PbrtParams params,
              const Affine& world_from_texture);

  // Starts to decode the images that a file's text names.
  void expect_images_of(std::string_view text);

  // Value of a material's parameter: a constant, a named texture, or `fallback`. Throws InputError
  // for wrong types, unknown textures and textures that contain themselves.
  ColorInput color(const PbrtParams& params, std::string_view name, Rgb fallback);
  FloatInput real(const PbrtParams& params, std::string_view name, float fallback);

  // Returns the index of an image texture in pbrt's (u,v): (0,0) is the lower left corner.
  int32_t image(const std::string& file, bool is_srgb, WrapMode wrap = WrapMode::repeat);

  PbrtSpectrumContext spectrum_context() { return {folder_, scene_.warnings}; }
  const std::string& folder() const { return folder_; }

 private:
  struct Named {
    std::string kind;
    bool is_float = false;
    PbrtParams params;
    Affine world_from_texture;
    bool is_being_made = false, is_made = false;
    ColorInput value{Rgb{1}, no_texture};
    size_t images = 0;  // images that one lookup reads
  };

  Scene& scene_;
  std::string folder_;
  TextureLoader loader_;
  std::map<std::string, Named> floats_, colors_;
  std::set<std::string> expected_;  // files passed to the loader in advance
  int depth_ = 0;

  Named& find(const std::string& name, bool is_float, const PbrtParam& asked_by);
  void make(Named& texture, const std::string& name);
  void make_image(Named& texture, const std::string& name);
  void make_scale(Named& texture, const std::string& name);
  // The next two return false if the texture has arguments that they do not handle.
  bool make_checkerboard(Named& texture, const std::string& name);
  bool make_mix(Named& texture);
  // Makes a pattern or noise. Returns false for unknown kinds.
  bool make_pattern(Named& texture, const std::string& name);
  void read_mapping(const Named& texture, bool is_solid, Texture& look);
  void set_operands(Named& texture, std::string_view first, std::string_view second,
                    Texture& pattern);
  void make_mean(Named& texture);
  ColorInput argument(const PbrtParams& params, std::string_view name, bool is_float, Rgb fallback,
                      size_t& images);
  int32_t load(const std::string& file, const Texture& look);
};

}  // namespace troffer
