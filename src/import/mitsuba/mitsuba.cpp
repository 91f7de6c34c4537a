#include "import/mitsuba/mitsuba.h"

#include <algorithm>

#include "import/absorption.h"
#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_light.h"
#include "import/mitsuba/mitsuba_sensor.h"
#include "import/mitsuba/mitsuba_shape.h"
#include "import/mitsuba/mitsuba_values.h"
#include "import/placed_geometry.h"

namespace troffer {

namespace {

constexpr int max_shape_depth = 8;  // nesting of shapes in shapes

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
  // Elements that a shape has besides its geometry.
  struct Attached {
    // The shape's last bsdf. The named bsdfs of an OBJ shape belong to the file's materials.
    const MitsubaNode* bsdf = nullptr;
    std::vector<std::pair<std::string, const MitsubaNode*>> by_material;
    const MitsubaNode* emitter = nullptr;
    bool has_medium = false;  // on either side
    Rgb absorption{0};        // absorption of the medium inside, per metre
  };

  Scene& scene_;
  MitsubaTree tree_;
  MitsubaTextures textures_;
  MitsubaBsdfs bsdfs_;
  MitsubaShapes shapes_;
  GeometryPlacer placer_;
  // Shapes of groups, shared by their instances.
  std::map<std::pair<const MitsubaNode*, std::string>,
           std::shared_ptr<const std::optional<MitsubaShape>>>
      in_groups_;
  std::map<const MitsubaNode*, std::unique_ptr<MitsubaAttributes>> attributes_;  // by shape
  size_t lights_ = 0;
  int depth_ = 0;

  void read_element(const MitsubaNode& node);
  void read_integrator(const MitsubaNode& node);
  void add_shape(const MitsubaNode& node, const Affine& parent, bool is_instance);
  void add_plain_shape(const MitsubaNode& node, const Affine& world, bool is_instance);
  void add_part(const MitsubaNode& node, const Affine& world, bool is_instance,
                const Attached& with, const MitsubaObjPart* part);
  std::optional<uint32_t> material_of(const Attached& with, bool is_emitting);
  MitsubaAttributes* attributes_of(const MitsubaNode& node, const MitsubaShape& shape,
                                   const Attached& with);
  bool shows_images(const MitsubaNode& node) const;
  void add_instance(const MitsubaNode& node, const Affine& parent);
  void add_children(const MitsubaNode& group, const Affine& parent, bool is_instance);
  Attached attached_to(const MitsubaNode& node);
  Rgb absorption_of(const MitsubaNode& medium);
  std::optional<EmissionSpec> emission_of(const MitsubaNode& shape, const MitsubaNode& emitter);
  void place(const MitsubaShape& shape, const Affine& world, const ShapeAttributes& look);
};

void MitsubaReader::read() {
  for (const MitsubaNode* child : tree_.root().children) read_element(*child);
}

void MitsubaReader::read_element(const MitsubaNode& node) {
  if (node.tag == "shape") {
    add_shape(node, Affine(), false);
  } else if (node.tag == "emitter") {
    // A top-level area light emits only from shapes that refer to it.
    if (node.type != "area") add_mitsuba_light(node, tree_, textures_, scene_);
  } else if (node.tag == "sensor") {
    add_mitsuba_camera(node, tree_, scene_);
  } else if (node.tag == "integrator") {
    read_integrator(node);
  } else if (node.tag == "medium") {
    // Media are read where shapes refer to them.
  } else if (node.tag != "bsdf" && node.tag != "texture" && node.tag != "sampler" &&
             node.tag != "film" && node.tag != "spectrum" && node.tag != "boolean" &&
             node.tag != "ref" && node.tag != "rfilter") {
    scene_.warnings.add("<" + shortened(node.tag) + "> is not known: left out");
  }
}

// The command line sets how to render, so only parameters that change the light add warnings.
void MitsubaReader::read_integrator(const MitsubaNode& node) {
  if (get_flag(node, "hide_emitters", false))
    scene_.warnings.add("integrator: hide_emitters is not supported: sources are seen");
  const double depth = get_number(node, "max_depth", node.type == "direct" ? 2 : -1);
  if (depth > 0)
    scene_.warnings.add(
        "integrator: its max_depth is ignored and all bounces are computed; render --method path "
        "--depth " +
        std::to_string(int(std::min(depth, 1e6)) - 1) + " has the same limit");
  for (const MitsubaNode* child : node.children)
    if (child->tag == "integrator") read_integrator(*child);
}

// Absorption of a medium per metre. Scattering is left out with a warning.
Rgb MitsubaReader::absorption_of(const MitsubaNode& medium) {
  medium.is_used = true;
  if (medium.type != "homogeneous") {
    scene_.warnings.add("a medium that is not homogeneous is left out");
    return Rgb{0};
  }
  const auto color = [&](const char* name, Rgb fallback) {
    const MitsubaNode* p = find_parameter(medium, name);
    if (!p || !is_color(tree_.resolved(*p))) return fallback;
    return color_of(tree_.resolved(*p), tree_.folder(), scene_.warnings, SpectrumUse::factor);
  };
  const float scale = float(get_number(medium, "scale", 1));
  const Rgb albedo = clamp01(color("albedo", Rgb{0.75f})), all = color("sigma_t", Rgb{1});
  const bool is_split = find_parameter(medium, "sigma_a") != nullptr;
  const Rgb absorbed = is_split ? color("sigma_a", Rgb{0}) : all * (Rgb{1} - albedo);
  const bool scatters = is_split ? !color("sigma_s", Rgb{0}).is_black() : !albedo.is_black();
  if (scatters) scene_.warnings.add("media inside objects absorb but do not scatter");
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
      out.by_material.emplace_back(child->name, &inner);
    } else if (inner.tag == "emitter") {
      child->is_used = true;
      out.emitter = &inner;
    } else if (inner.tag == "medium" && child->name == "interior") {
      child->is_used = true;
      out.has_medium = true;
      out.absorption = absorption_of(inner);
    } else if (inner.tag == "medium" || inner.tag == "subsurface") {
      child->is_used = true;
      out.has_medium = out.has_medium || inner.tag == "medium";
      scene_.warnings.add("participating media around objects are not supported: left out");
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
  if (node.type == "shapegroup") return;  // placed by its instances
  if (++depth_ > max_shape_depth) node.place.fail("shapes contain each other too deeply");
  if (node.type == "instance") {
    add_instance(node, parent);
  } else if (node.type == "merge") {
    add_children(node, parent, is_instance);
  } else {
    add_plain_shape(node, parent * get_transform(node, "to_world"), is_instance);
  }
  --depth_;
}

void MitsubaReader::add_plain_shape(const MitsubaNode& node, const Affine& world,
                                    bool is_instance) {
  Attached with = attached_to(node);
  const bool is_split = node.type == "obj" && with.by_material.size() > 1 && !with.emitter;
  if (!is_split) {
    add_part(node, world, is_instance, with, nullptr);
    return;
  }
  MitsubaObjPart rest;
  for (const auto& [name, bsdf] : with.by_material) rest.others.push_back(name);
  for (const auto& [name, bsdf] : with.by_material) {
    if (name.empty()) continue;
    with.bsdf = bsdf;
    const MitsubaObjPart part{name, {}};
    add_part(node, world, is_instance, with, &part);
  }
  const auto unnamed = std::find_if(with.by_material.begin(), with.by_material.end(),
                                    [](const auto& entry) { return entry.first.empty(); });
  with.bsdf = unnamed == with.by_material.end() ? nullptr : unnamed->second;
  add_part(node, world, is_instance, with, &rest);
}

// Returns nothing for surfaces that light passes unchanged. Up to version 0.6 these include
// surfaces without bsdf between two media.
std::optional<uint32_t> MitsubaReader::material_of(const Attached& with, bool is_emitting) {
  std::optional<uint32_t> material;
  if (with.bsdf)
    material = bsdfs_.index_of(*with.bsdf);
  else if (is_emitting || !with.has_medium || !tree_.is_legacy())
    material = bsdfs_.default_index(is_emitting);
  if (!material && is_emitting) material = bsdfs_.invisible_index();
  if (!material || with.absorption.is_black()) return material;
  if (scene_.materials[*material].kind == MaterialKind::dielectric)
    return bsdfs_.with_medium(*material, with.absorption);
  scene_.warnings.add("media inside anything but \"dielectric\" are left out");
  return material;
}

void MitsubaReader::add_part(const MitsubaNode& node, const Affine& world, bool is_instance,
                             const Attached& with, const MitsubaObjPart* part) {
  const std::pair key{&node, part ? part->name : ""};
  std::shared_ptr<const std::optional<MitsubaShape>> shape;
  if (is_instance && in_groups_.contains(key)) shape = in_groups_[key];
  if (!shape) shape = std::make_shared<const std::optional<MitsubaShape>>(shapes_.read(node, part));
  if (is_instance) in_groups_[key] = shape;
  ShapeAttributes look;
  look.place = node.place;
  MitsubaAttributes* attributes = *shape ? attributes_of(node, **shape, with) : nullptr;
  textures_.set_attributes(attributes);
  if (with.emitter && is_instance) scene_.warnings.add("emitters of instances do not emit");
  if (with.emitter && !is_instance) look.emission = emission_of(node, *with.emitter);
  const std::optional<uint32_t> material = material_of(with, look.emission.has_value());
  textures_.set_attributes(nullptr);
  warn_of_unused(node, scene_.warnings);
  if (attributes && attributes->uses() > 0) {
    auto own = std::make_shared<std::optional<MitsubaShape>>(*shape);
    attributes->finish((*own)->mesh.mesh);
    shape = own;
    if (is_instance) in_groups_[key] = shape;
  }
  if (!material || !*shape) return;
  if (part && part->name.empty() && !with.bsdf)
    scene_.warnings.add("materials of an OBJ file without a bsdf of the same name are shown grey");
  look.material = *material;
  if (is_instance) look.shape = &**shape;
  place(**shape, world, look);
}

// True if a bsdf or emitter has textures that are looked up by the shape's (u,v).
bool MitsubaReader::shows_images(const MitsubaNode& given) const {
  const MitsubaNode& node = tree_.resolved(given);
  if (node.tag == "texture" && (node.type == "bitmap" || node.type == "checkerboard")) return true;
  return std::any_of(node.children.begin(), node.children.end(), [&](const MitsubaNode* child) {
    return (child->tag == "texture" || child->tag == "bsdf" || child->tag == "ref") &&
           shows_images(*child);
  });
}

// Attributes of a shape from a PLY file; null for other shapes.
MitsubaAttributes* MitsubaReader::attributes_of(const MitsubaNode& node, const MitsubaShape& shape,
                                                const Attached& with) {
  if (node.type != "ply") return nullptr;
  std::unique_ptr<MitsubaAttributes>& a = attributes_[&node];
  if (!a) {
    const bool has_images =
        (with.bsdf && shows_images(*with.bsdf)) || (with.emitter && shows_images(*with.emitter));
    a = std::make_unique<MitsubaAttributes>(shapes_.file_path(node), shape.mesh.mesh, has_images,
                                            scene_);
  }
  return a.get();
}

void MitsubaReader::place(const MitsubaShape& shape, const Affine& world,
                          const ShapeAttributes& look) {
  if (shape.kind == MitsubaShapeKind::sphere) {
    placer_.add_sphere(world, shape.centre, shape.radius, shape.is_turned, look);
  } else if (shape.kind == MitsubaShapeKind::disk) {
    if (placer_.needs_coordinates(look)) {
      const bool is_mirrored = world.swaps_handedness();
      placer_.add_mesh({mitsuba_disk(), {}}, world, shape.is_turned != is_mirrored, look);
      return;
    }
    placer_.add_disk(world, shape.radius, shape.is_turned, look);
  } else {
    const bool is_mirrored = shape.keeps_side && world.swaps_handedness();
    if (shape.mesh.mesh.uvs.empty() && !look.shape && placer_.needs_coordinates(look)) {
      AnchoredMesh with_uvs = shape.mesh;
      add_corner_uvs(with_uvs.mesh);
      placer_.add_mesh(with_uvs, world, shape.is_turned != is_mirrored, look);
      return;
    }
    placer_.add_mesh(shape.mesh, world, shape.is_turned != is_mirrored, look);
  }
}

}  // namespace

Scene import_mitsuba(const std::string& path, ImageUse images) {
  return import_recentred(
      [&](Scene& scene, PlacedBounds& bounds) {
        scene.file = path;
        MitsubaReader(path, scene, bounds).read();
      },
      images);
}

}  // namespace troffer
