// Interpreter of pbrt files: carries out one directive after the other and adds to a scene. Used by
// import_pbrt. Its functions are in pbrt.cpp (the world) and pbrt_interpreter.cpp (everything
// else).
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/transform.h"
#include "import/pbrt/pbrt_camera.h"
#include "import/pbrt/pbrt_color_space.h"
#include "import/pbrt/pbrt_material.h"
#include "import/pbrt/pbrt_place.h"
#include "import/pbrt/pbrt_shape.h"

namespace troffer {

class PbrtInterpreter {
 public:
  PbrtInterpreter(Scene& scene, const std::string& path, PlacedBounds& bounds);
  // Reads the whole file and all files that it includes. Throws InputError as import_pbrt does.
  void run();

 private:
  // by target of the Attribute directive
  using Defaults = std::map<std::string, std::vector<PbrtParam>>;
  struct State {
    Affine transform;  // at the start of the shutter interval
    bool is_reversed = false;
    std::shared_ptr<PbrtMaterial> material;
    std::shared_ptr<const PbrtAreaLight> light;
    std::shared_ptr<const Defaults> defaults;
    bool is_start_active = true, is_end_active = true;
    Rgb absorption{0};  // absorption of the medium inside shapes, per metre
    PbrtColorSpace color_space = PbrtColorSpace::srgb;
  };
  enum class Block { attribute, object };
  struct Saved {
    State state;
    Block block;
    PbrtPlace place;
  };
  using Handler = void (PbrtInterpreter::*)(const PbrtToken&, PbrtTokenizer&);
  static const std::map<std::string_view, Handler>& handlers();

  Scene& scene_;
  std::string path_;
  PbrtMaterials materials_;
  PbrtPlacer placer_;
  State state_;
  std::vector<Saved> saved_;
  bool is_in_world_ = false;
  struct ByName {
    std::map<std::string, Affine> coordinate_systems;
    std::map<std::string, std::shared_ptr<PbrtMaterial>> materials;
    std::map<std::string, std::vector<PbrtShape>> objects;
    std::map<std::string, Rgb> media;  // absorption per metre
  } named_;
  std::vector<PbrtShape>* open_object_ = nullptr;
  struct Files {
    std::vector<std::string> open;
    size_t read = 0;
    uint64_t bytes_read = 0;
  } files_;

  // Read before WorldBegin. The camera is made there, when the film is known.
  PbrtFilm film_;
  struct PendingCamera {
    std::string type;
    PbrtParams params;
    Affine camera_from_world;
  };
  std::unique_ptr<PendingCamera> camera_;

  void run_file(const std::string& path, const PbrtPlace* included_at);
  void run_directive(const PbrtToken& word, PbrtTokenizer& tokens);
  std::string parse_string(const PbrtToken& word, PbrtTokenizer& tokens);
  PbrtParams parse_typed(const PbrtToken& word, PbrtTokenizer& tokens, const std::string& type,
                         const std::string& target);
  void need_world(const PbrtToken& word, PbrtTokenizer& tokens) const;
  void need_options(const PbrtToken& word, PbrtTokenizer& tokens) const;
  void push(Block block, const PbrtPlace& place);
  void pop(Block block, const PbrtToken& word, PbrtTokenizer& tokens);

  void on_include(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_import(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_attribute_begin(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_attribute_end(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_attribute(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_object_begin(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_object_end(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_object_instance(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_coordinate_system(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_coordinate_system_transform(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_active_transform(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_transform_times(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_reverse_orientation(const PbrtToken& word, PbrtTokenizer& tokens);
  void resolve_mix(PbrtMaterial& material) const;
  void on_material(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_make_named_material(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_named_material(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_texture(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_shape(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_area_light(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_light(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_medium_interface(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_make_named_medium(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_camera(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_film(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_sampling(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_option(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_color_space(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_world_begin(const PbrtToken& word, PbrtTokenizer& tokens);
  void on_world_end(const PbrtToken& word, PbrtTokenizer& tokens);
};

}  // namespace troffer
