// Directives inside the world (shapes, materials, lights, objects), and the table of all
// directives.
#include "import/pbrt/pbrt.h"

#include <algorithm>
#include <cmath>

#include "import/pbrt/pbrt_interpreter.h"
#include "import/pbrt/pbrt_light.h"

namespace troffer {

void PbrtInterpreter::on_object_begin(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const PbrtPlace place = tokens.place(word);
  const std::string name = parse_string(word, tokens);
  if (open_object_) fail_at(place, "ObjectBegin within an object");
  if (named_.objects.contains(name)) fail_at(place, "object \"" + name + "\" is defined twice");
  push(Block::object, place);
  open_object_ = &named_.objects[name];
}

void PbrtInterpreter::on_object_end(const PbrtToken& word, PbrtTokenizer& tokens) {
  pop(Block::object, word, tokens);
  open_object_ = nullptr;
}

void PbrtInterpreter::on_object_instance(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const PbrtPlace place = tokens.place(word);
  const std::string name = parse_string(word, tokens);
  // Objects hold shapes only, so instances cannot contain each other.
  if (open_object_) fail_at(place, "ObjectInstance within an object");
  const auto found = named_.objects.find(name);
  if (found == named_.objects.end()) fail_at(place, "no object \"" + name + "\" is defined");
  for (const PbrtShape& shape : found->second)
    placer_.place_instance(shape, state_.transform, place);
}

// Resolves the two materials of a mix. They must be defined earlier, so a mix cannot contain
// itself.
void PbrtInterpreter::resolve_mix(PbrtMaterial& material) const {
  constexpr int most_depth = 8;  // each level may double the number of materials
  if (material.type != "mix") return;
  const PbrtParam* names = material.params.find("materials");
  if (!names || names->strings.size() != 2)
    fail_at(material.params.place, "a mix needs two names as \"string materials\"");
  for (const std::string& name : names->strings) {
    const auto found = named_.materials.find(name);
    if (found == named_.materials.end())
      fail_at(names->place, "no material \"" + name + "\" is defined before this point");
    material.mixed.push_back(found->second);
    material.depth = std::max(material.depth, found->second->depth + 1);
  }
  if (material.depth > most_depth) fail_at(names->place, "mixes are nested too deeply");
}

void PbrtInterpreter::on_material(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  auto material = std::make_shared<PbrtMaterial>();
  material->type = parse_string(word, tokens);
  material->params = parse_typed(word, tokens, material->type, "material");
  resolve_mix(*material);
  state_.material = std::move(material);
}

void PbrtInterpreter::on_make_named_material(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  auto material = std::make_shared<PbrtMaterial>();
  material->name = parse_string(word, tokens);
  material->params = parse_typed(word, tokens, material->name, "material");
  if (!material->params.has("type"))
    fail_at(tokens.place(word), "material \"" + material->name + "\" needs a \"string type\"");
  material->type = material->params.get_string("type", "");
  resolve_mix(*material);
  if (named_.materials.contains(material->name))
    scene_.warnings.add(
        at_place(tokens.place(word), "material \"" + material->name + "\" is defined again"));
  named_.materials[material->name] = std::move(material);
}

void PbrtInterpreter::on_named_material(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const PbrtPlace place = tokens.place(tokens.peek());
  const std::string name = parse_string(word, tokens);
  const auto found = named_.materials.find(name);
  if (found == named_.materials.end())
    fail_at(place, "no material \"" + name + "\" is defined before this point");
  state_.material = found->second;
}

void PbrtInterpreter::on_texture(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const std::string name = parse_string(word, tokens);
  const PbrtPlace place = tokens.place(tokens.peek());
  const std::string value_type = parse_string(word, tokens);
  if (value_type == "color")
    fail_at(place, "texture type \"color\" is pbrt-v3 syntax; pbrt-v4 says \"spectrum\"");
  if (value_type != "float" && value_type != "spectrum")
    fail_at(place, "texture type \"" + value_type + "\" is neither float nor spectrum");
  const std::string kind = parse_string(word, tokens);
  materials_.textures.define(name, value_type == "float", kind,
                             parse_typed(word, tokens, kind, "texture"), state_.transform);
}

void PbrtInterpreter::on_shape(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const std::string type = parse_string(word, tokens);
  const PbrtParams params = parse_typed(word, tokens, type, "shape");
  PbrtShape shape;
  const bool shines = state_.light && !open_object_;
  if (!read_pbrt_shape(type, params, shines, materials_.textures, scene_.warnings, shape)) {
    if (shines) placer_.skip_light();
    return;
  }
  shape.world_from_object = state_.transform;
  shape.is_reversed = state_.is_reversed;
  shape.material = state_.material;
  shape.light = state_.light;
  shape.absorption = state_.absorption;
  if (!open_object_) {
    placer_.place(shape, params.place);
    return;
  }
  if (shape.light) scene_.warnings.add("area light within an object: instances do not emit");
  placer_.count_waiting(shape, params.place);
  open_object_->push_back(std::move(shape));
}

void PbrtInterpreter::on_area_light(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const std::string type = parse_string(word, tokens);
  const PbrtParams params = parse_typed(word, tokens, type, "light");
  if (type != "diffuse") {
    scene_.warnings.add("AreaLightSource \"" + type +
                        "\" is not supported: its shapes do not emit");
    state_.light.reset();
    return;
  }
  PbrtAreaLight light;
  light.image = params.get_string("filename", "");
  const PbrtParam* radiance = params.find("L");
  if (radiance && !light.image.empty())
    fail_at(radiance->place, "an area light has either \"L\" or \"filename\"");
  light.radiance =
      radiance ? emission_value(*radiance, materials_.textures.spectrum_context()) : Rgb{1};
  const auto scale = float(params.get_float("scale", 1));
  if (!(scale >= 0 && std::isfinite(scale)))
    fail_at(params.find("scale")->place, "scale must be a number, not negative");
  light.radiance *= scale;
  light.power = params.get_float("power", 0);
  light.is_two_sided = params.get_bool("twosided", false);
  params.warn_unread(scene_.warnings);
  state_.light = std::make_shared<const PbrtAreaLight>(light);
}

void PbrtInterpreter::on_light(const PbrtToken& word, PbrtTokenizer& tokens) {
  need_world(word, tokens);
  const std::string type = parse_string(word, tokens);
  const PbrtParams params = parse_typed(word, tokens, type, "light");
  const std::string name = "light" + std::to_string(placer_.next_light_source());
  if (open_object_)
    scene_.warnings.add("LightSource within an object: it is not repeated by instances");
  auto light = read_pbrt_light(type, params, state_.transform,
                               materials_.textures.spectrum_context(), scene_);
  if (!light) return;
  light->name = name;
  scene_.lights.push_back(std::move(*light));
}

void PbrtInterpreter::on_medium_interface(const PbrtToken& word, PbrtTokenizer& tokens) {
  const std::string inside = parse_string(word, tokens);
  std::string outside = inside;
  if (tokens.peek().kind == PbrtTokenKind::string) outside = parse_string(word, tokens);
  if (!outside.empty() && outside != inside)
    scene_.warnings.add("MediumInterface: media around objects are not supported: left out");
  state_.absorption = Rgb{0};
  if (inside.empty()) return;
  const auto found = named_.media.find(inside);
  if (found == named_.media.end())
    fail_at(tokens.place(word), "no medium \"" + inside + "\" is defined before this point");
  state_.absorption = found->second;
}

void PbrtInterpreter::on_make_named_medium(const PbrtToken& word, PbrtTokenizer& tokens) {
  const std::string name = parse_string(word, tokens);
  const PbrtParams params = parse_typed(word, tokens, name, "medium");
  named_.media[name] = materials_.read_medium(params.get_string("type", ""), params);
}

const std::map<std::string_view, PbrtInterpreter::Handler>& PbrtInterpreter::handlers() {
  using I = PbrtInterpreter;
  static const std::map<std::string_view, Handler> table{
      {"Accelerator", &I::on_sampling},
      {"ActiveTransform", &I::on_active_transform},
      {"AreaLightSource", &I::on_area_light},
      {"Attribute", &I::on_attribute},
      {"AttributeBegin", &I::on_attribute_begin},
      {"AttributeEnd", &I::on_attribute_end},
      {"Camera", &I::on_camera},
      {"ColorSpace", &I::on_color_space},
      {"CoordSysTransform", &I::on_coordinate_system_transform},
      {"CoordinateSystem", &I::on_coordinate_system},
      {"Film", &I::on_film},
      {"Import", &I::on_import},
      {"Include", &I::on_include},
      {"Integrator", &I::on_sampling},
      {"LightSource", &I::on_light},
      {"MakeNamedMaterial", &I::on_make_named_material},
      {"MakeNamedMedium", &I::on_make_named_medium},
      {"Material", &I::on_material},
      {"MediumInterface", &I::on_medium_interface},
      {"NamedMaterial", &I::on_named_material},
      {"ObjectBegin", &I::on_object_begin},
      {"ObjectEnd", &I::on_object_end},
      {"ObjectInstance", &I::on_object_instance},
      {"Option", &I::on_option},
      {"PixelFilter", &I::on_sampling},
      {"ReverseOrientation", &I::on_reverse_orientation},
      {"Sampler", &I::on_sampling},
      {"Shape", &I::on_shape},
      {"Texture", &I::on_texture},
      {"TransformBegin", &I::on_attribute_begin},
      {"TransformEnd", &I::on_attribute_end},
      {"TransformTimes", &I::on_transform_times},
      {"WorldBegin", &I::on_world_begin},
      {"WorldEnd", &I::on_world_end},
  };
  return table;
}

Scene import_pbrt(const std::string& path, ImageUse images) {
  return import_recentred(
      [&](Scene& scene, PlacedBounds& bounds) {
        scene.file = path;
        PbrtInterpreter(scene, path, bounds).run();
      },
      images);
}

}  // namespace troffer
