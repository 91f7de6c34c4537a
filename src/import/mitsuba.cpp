#include "import/mitsuba.h"

#include "import/absorption.h"
#include "import/mitsuba_bsdf.h"
#include "import/mitsuba_light.h"
#include "import/mitsuba_sensor.h"
#include "import/mitsuba_shape.h"
#include "import/mitsuba_values.h"
#include "import/placed_geometry.h"

namespace troffer {

namespace {

constexpr int max_shape_depth = 8;  // of shapes in shapes

class MitsubaReader {
 public:
  MitsubaReader(const std::string& path, Scene& scene, PlacedBounds& bounds)
      : scene_(scene),
        tree_(path, scene.warnings),
        textures_(scene, tree_),
        bsdfs_(scene, tree_, textures_),
        shapes_(tree_, scene.warnings),
        placer_(scene, bounds) {}
  void read();

 private:
  // What a shape has beside its geometry.
  struct Attached {
    const MitsubaNode* bsdf = nullptr;
    const MitsubaNode* emitter = nullptr;
    Rgb absorption{0};  // of the medium inside
  };

  Scene& scene_;
  MitsubaTree tree_;
  MitsubaTextures textures_;
  MitsubaBsdfs bsdfs_;
  MitsubaShapes shapes_;
  GeometryPlacer placer_;
  // Shapes of groups, which many instances place.
  std::map<const MitsubaNode*, std::shared_ptr<const std::optional<MitsubaShape>>> in_groups_;
  size_t lights_ = 0;
  int depth_ = 0;

  void read_element(const MitsubaNode& node);
  void add_shape(const MitsubaNode& node, const Affine& parent, bool is_instance);
  void add_instance(const MitsubaNode& node, const Affine& parent);
  void add_children(const MitsubaNode& group, const Affine& parent, bool is_instance);
  Attached attached_to(const MitsubaNode& node);
  Rgb absorption_of(const MitsubaNode& medium);
  std::optional<EmissionSpec> emission_of(const MitsubaNode& shape, const MitsubaNode& emitter);
  void place(const MitsubaShape& shape, const Affine& world, const PlacedLook& look);
};

void MitsubaReader::read() {
  for (const MitsubaNode* child : tree_.root().children) read_element(*child);
}

void MitsubaReader::read_element(const MitsubaNode& node) {
  if (node.tag == "shape") {
    add_shape(node, Affine(), false);
  } else if (node.tag == "emitter") {
    // An area light that stands by itself waits for shapes that refer to it.
    if (node.type != "area") add_mitsuba_light(node, tree_, scene_);
  } else if (node.tag == "sensor") {
    add_mitsuba_camera(node, tree_, scene_);
  } else if (node.tag == "medium") {
    // Those of shapes are read where shapes name them.
  } else if (node.tag != "bsdf" && node.tag != "texture" && node.tag != "integrator" &&
             node.tag != "sampler" && node.tag != "film" && node.tag != "spectrum" &&
             node.tag != "boolean" && node.tag != "ref" && node.tag != "rfilter") {
    scene_.warnings.add("<" + shortened(node.tag) + "> is not known: left out");
  }
}

// What a medium absorbs per metre; that it scatters is left out.
Rgb MitsubaReader::absorption_of(const MitsubaNode& medium) {
  medium.is_used = true;
  if (medium.type != "homogeneous") {
    scene_.warnings.add("a medium that is not homogeneous is left out");
    return Rgb{0};
  }
  const auto color = [&](const char* name, Rgb fallback) {
    const MitsubaNode* p = find_parameter(medium, name);
    if (!p || !is_color(tree_.resolved(*p))) return fallback;
    return color_of(tree_.resolved(*p), tree_.folder(), scene_.warnings, false);
  };
  const float scale = float(get_number(medium, "scale", 1));
  const Rgb albedo = clamp01(color("albedo", Rgb{0.75f})), all = color("sigma_t", Rgb{1});
  const bool is_split = find_parameter(medium, "sigma_a") != nullptr;
  const Rgb absorbed = is_split ? color("sigma_a", Rgb{0}) : all * (Rgb{1} - albedo);
  const bool scatters = is_split ? !color("sigma_s", Rgb{0}).is_black() : !albedo.is_black();
  if (scatters) scene_.warnings.add("media inside things absorb, but do not scatter");
  for (const char* name : {"material", "sample_emitters", "phase"}) find_parameter(medium, name);
  return usable_absorption(absorbed * scale);
}

MitsubaReader::Attached MitsubaReader::attached_to(const MitsubaNode& node) {
  Attached out;
  for (const MitsubaNode* child : node.children) {
    const MitsubaNode& inner = tree_.resolved(*child);
    if (inner.tag == "bsdf") {
      child->is_used = true;
      out.bsdf = &inner;
    } else if (inner.tag == "emitter") {
      child->is_used = true;
      out.emitter = &inner;
    } else if (inner.tag == "medium" && child->name == "interior") {
      child->is_used = true;
      out.absorption = absorption_of(inner);
    } else if (inner.tag == "medium" || inner.tag == "subsurface") {
      child->is_used = true;
      scene_.warnings.add("participating media around things are not supported: left out");
    }
  }
  return out;
}

std::optional<EmissionSpec> MitsubaReader::emission_of(const MitsubaNode& shape,
                                                       const MitsubaNode& emitter) {
  EmissionSpec spec;
  spec.name = "emitter" + std::to_string(lights_++);
  if (!emitter.id.empty()) spec.name = emitter.id;
  if (!shape.id.empty()) spec.name = shape.id;
  if (emitter.type != "area") {
    scene_.warnings.add("emitter \"" + shortened(emitter.type) +
                        "\" on a shape is shown as \"area\"");
  }
  if (const MitsubaNode* radiance = find_parameter(emitter, "radiance")) {
    const ColorInput c = textures_.emission(*radiance);
    spec.radiance = c.value;
    spec.texture = c.texture;
  } else {
    spec.radiance = Rgb{1};
  }
  find_parameter(emitter, "sampling_weight");
  warn_of_unused(emitter, scene_.warnings);
  return spec;
}

void MitsubaReader::add_instance(const MitsubaNode& node, const Affine& parent) {
  const Affine world = parent * get_transform(node, "to_world");
  for (const MitsubaNode* child : node.children) {
    const MitsubaNode& group = tree_.resolved(*child);
    if (group.tag != "shape") continue;
    child->is_used = true;
    if (group.type == "shapegroup")
      add_children(group, world, true);
    else
      add_shape(group, world, true);
  }
  warn_of_unused(node, scene_.warnings);
}

void MitsubaReader::add_children(const MitsubaNode& group, const Affine& parent, bool is_instance) {
  for (const MitsubaNode* child : group.children) {
    const MitsubaNode& inner = tree_.resolved(*child);
    if (inner.tag != "shape") continue;
    child->is_used = true;
    add_shape(inner, parent, is_instance);
  }
}

void MitsubaReader::add_shape(const MitsubaNode& node, const Affine& parent, bool is_instance) {
  if (node.type == "shapegroup") return;  // shown by its instances
  if (++depth_ > max_shape_depth) node.place.fail("shapes contain each other too deeply");
  if (node.type == "instance") {
    add_instance(node, parent);
  } else if (node.type == "merge") {
    add_children(node, parent, is_instance);
  } else {
    const Affine world = parent * get_transform(node, "to_world");
    std::shared_ptr<const std::optional<MitsubaShape>> shape;
    if (is_instance && in_groups_.contains(&node)) shape = in_groups_[&node];
    if (!shape) shape = std::make_shared<const std::optional<MitsubaShape>>(shapes_.read(node));
    if (is_instance) in_groups_[&node] = shape;
    const Attached with = attached_to(node);
    PlacedLook look;
    look.place = node.place;
    if (with.emitter && is_instance) scene_.warnings.add("emitters of instances do not emit");
    if (with.emitter && !is_instance) look.emission = emission_of(node, *with.emitter);
    std::optional<uint32_t> material;
    if (with.bsdf)
      material = bsdfs_.index_of(*with.bsdf);
    else
      material = bsdfs_.default_index(look.emission.has_value());
    if (!material && look.emission) {
      scene_.warnings.add("a shape of bsdf \"null\" that emits is shown black");
      material = bsdfs_.default_index(true);
    }
    if (material && !with.absorption.is_black()) {
      if (scene_.materials[*material].kind == MaterialKind::dielectric)
        material = bsdfs_.with_medium(*material, with.absorption);
      else
        scene_.warnings.add("media inside anything but \"dielectric\" are left out");
    }
    warn_of_unused(node, scene_.warnings);
    if (material && *shape) {
      look.material = *material;
      if (is_instance) look.shape = &**shape;
      place(**shape, world, look);
    }
  }
  --depth_;
}

void MitsubaReader::place(const MitsubaShape& shape, const Affine& world, const PlacedLook& look) {
  if (shape.kind == MitsubaShapeKind::sphere) {
    placer_.add_sphere(world, shape.centre, shape.radius, shape.is_turned, look);
  } else if (shape.kind == MitsubaShapeKind::disk) {
    placer_.add_disk(world, shape.radius, shape.is_turned, look);
  } else {
    const bool is_mirrored = shape.keeps_side && world.swaps_handedness();
    placer_.add_mesh(shape.mesh, world, shape.is_turned != is_mirrored, look);
  }
}

}  // namespace

Scene import_mitsuba(const std::string& path) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    MitsubaReader(path, scene, bounds).read();
  });
}

}  // namespace troffer
