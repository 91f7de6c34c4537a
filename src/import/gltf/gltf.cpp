#include "import/gltf/gltf.h"

#include <optional>
#include <vector>

#include "base/error.h"
#include "import/emissive.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_animation.h"
#include "import/gltf/gltf_baked.h"
#include "import/gltf/gltf_camera.h"
#include "import/gltf/gltf_file.h"
#include "import/gltf/gltf_ies.h"
#include "import/gltf/gltf_image_light.h"
#include "import/gltf/gltf_json.h"
#include "import/gltf/gltf_light.h"
#include "import/gltf/gltf_material.h"
#include "import/gltf/gltf_mesh.h"
#include "import/gltf/gltf_nodes.h"
#include "import/gltf/gltf_pose.h"
#include "import/gltf/gltf_schema.h"
#include "import/gltf/gltf_variant.h"
#include "import/gltf/mesh_instancer.h"
#include "import/limits.h"
#include "import/recentre.h"
#include "import/vertex_paint.h"

namespace troffer {

namespace {

// Cost of one instance, in triangles, in the limit on stored triangles.
constexpr uint64_t cost_of_instance = 20;
constexpr const char* lights_extension = "KHR_lights_punctual";

// Reads one document into a scene. It has thirteen members: the file, the readers of its parts, and
// what they have read.
class Importer {
 public:
  Importer(const JsonNode& root, GltfFile& file, const ImportOptions& options, Scene& scene,
           PlacedBounds& bounds)
      : root_(root),
        options_(options),
        scene_(scene),
        bounds_(bounds),
        buffers_(root, file),
        materials_(root_, buffers_, scene),
        baked_(root_, buffers_, scene, options.shows_baked),
        painter_(scene),
        instancer_(scene, bounds) {
    materials_.on_read = [this](const JsonNode& node, GltfMaterial& made, TextureLoader& loader) {
      baked_.apply(node, made, loader);
    };
  }

  void run() {
    materials_.expect_images();
    read_primitives();
    read_poses();
    nodes_ = gltf_nodes(root_, poses_, scene_.warnings);
    for (GltfNode& node : nodes_.shown) node.world_from_node.translation -= scene_.origin;
    for (Affine& world : nodes_.world) world.translation -= scene_.origin;
    check_size();
    for (const GltfNode& node : nodes_.shown) add_node(node);
    warn_and_skip_on_error("an image-based light", "",
                           [&] { add_gltf_image_light(root_, buffers_, scene_); });
    materials_.check_unused_images();
    baked_.finish();
    if (scene_.meshes.empty() && scene_.instances.empty())
      scene_.warnings.add("the scene has no visible triangles");
  }

 private:
  void read_poses() {
    if (options_.time || options_.animation) {
      poses_ = gltf_poses(root_, buffers_, options_.time.value_or(0), options_.animation,
                          scene_.warnings);
      return;
    }
    const auto animations = root_.find("animations");
    if (animations && animations->size() > 0)
      scene_.warnings.add(
          "animations are not played: nodes stay where the file puts them (--time chooses a "
          "moment)");
  }

  JsonNode node_json(const GltfNode& node) const {
    return root_.member("nodes").element(node.index);
  }
  std::optional<uint32_t> mesh_of(const JsonNode& node) const {
    const auto mesh = node.find("mesh");
    if (!mesh) return std::nullopt;
    return mesh->as_index(meshes_.size(), "meshes");
  }

  void read_primitives() {
    const auto variant = find_gltf_variant(root_, options_.variant, scene_.warnings);
    const auto meshes = root_.find("meshes");
    for (size_t i = 0; meshes && i < meshes->size(); ++i) {
      const JsonNode list = meshes->element(i).member("primitives");
      auto& of_mesh = meshes_.emplace_back().primitives;
      for (size_t k = 0; k < list.size(); ++k)
        if (auto p = read_gltf_primitive(list.element(k), buffers_, scene_.warnings)) {
          if (variant)
            if (const auto other = gltf_variant_material(root_, list.element(k), *variant))
              p->material = other;
          of_mesh.push_back(std::move(*p));
        }
    }
  }

  // Fails if the scene exceeds the limits on triangles and instances. Runs before meshes are
  // created.
  void check_size() {
    uint64_t placed = 0, stored = 0, instances = 0;
    for (const GltfNode& node : nodes_.shown)
      if (const auto mesh = mesh_of(node_json(node)))
        meshes_[*mesh].uses += gltf_instances(node_json(node), buffers_).size();
    for (const GltfNode& node : nodes_.shown) {
      const JsonNode json = node_json(node);
      const auto mesh = mesh_of(json);
      if (!mesh) continue;
      const uint64_t n = gltf_instances(json, buffers_).size();
      instances += n;
      for (const GltfPrimitive& p : meshes_[*mesh].primitives) {
        placed += n * p.triangle_count();
        // A shared mesh is stored once; its triangles are divided among its uses.
        stored += is_shared(p, *mesh, json)
                      ? n * cost_of_instance + p.triangle_count() / meshes_[*mesh].uses
                      : n * p.triangle_count();
      }
      if (stored > max_scene_triangles || placed > max_placed_triangles ||
          instances > max_scene_triangles)
        fail_of_size(json);
    }
  }

  [[noreturn]] static void fail_of_size(const JsonNode& node) {
    node.fail("the scene has more than " + std::to_string(max_scene_triangles) +
              " triangles, or more than " + std::to_string(max_placed_triangles) + " by instances");
  }

  // Runs `add` for one light or camera. If that throws InputError, leaves the light or camera out
  // and adds a warning that names it.
  template <class Add>
  void warn_and_skip_on_error(const char* kind, const std::string& name, const Add& add) {
    try {
      add();
    } catch (const InputError& e) {
      scene_.warnings.add(std::string(kind) + (name.empty() ? "" : " '" + printable(name) + "'") +
                          " cannot be used and is left out: " + e.what());
    }
  }

  void add_node(const GltfNode& node) {
    const JsonNode json = node_json(node);
    const std::string own_name = json.string_or("name", "");
    warn_and_skip_on_error("camera", own_name, [&] {
      if (const auto camera = json.find("camera")) add_camera(json, *camera, node.world_from_node);
    });
    warn_and_skip_on_error("light", own_name, [&] {
      if (const auto light = json.extension(lights_extension))
        add_light(json, light->member("light"), node.world_from_node);
    });
    warn_and_skip_on_error("light", own_name, [&] {
      if (const auto instance = json.extension("EXT_lights_ies"))
        add_gltf_ies_light(root_, *instance, node.world_from_node, own_name, buffers_, scene_);
    });
    const auto mesh = mesh_of(json);
    if (!mesh) return;
    const JsonNode mesh_json = root_.member("meshes").element(*mesh);
    GltfPose pose;
    const auto moved = poses_.find(node.index);
    pose.target_weights = moved != poses_.end() && moved->second.weights
                              ? *moved->second.weights
                              : gltf_target_weights(json, mesh_json);
    if (const auto skin = json.find("skin")) {
      const JsonNode skins = root_.member("skins");
      pose.joints =
          gltf_joints(skins.element(skin->as_index(skins.size(), "skins")), buffers_, nodes_.world);
    }
    const std::string node_name = json.string_or("name", "");
    const std::string name = node_name.empty() ? mesh_json.string_or("name", "") : node_name;
    for (const Affine& instance : gltf_instances(json, buffers_)) {
      pose.world_from_mesh = node.world_from_node * instance;
      for (const GltfPrimitive& p : meshes_[*mesh].primitives)
        if (!is_shared(p, *mesh, json)) {
          add_mesh(p, pose, name, node_name);
        } else if (!add_instance(p, pose, name)) {
          counts_.unshared += p.triangle_count();
          if (counts_.unshared > max_scene_triangles) fail_of_size(json);
          add_mesh(p, pose, name, node_name);
        }
    }
  }

  // True if the primitive is stored once and instanced. It must be used several times, keep its
  // shape in all uses, not emit, and be worth it (MeshInstancer). Single uses may still be copied;
  // see add_instance.
  bool is_shared(const GltfPrimitive& p, uint32_t mesh, const JsonNode& node) {
    const bool is_bent = !p.targets.empty() || (!p.joints.empty() && node.find("skin"));
    const GltfMaterial& material = materials_.get(p.material);
    return meshes_[mesh].uses > 1 && !is_bent && material.emission.is_black() &&
           instancer_.is_worth(p.triangle_count(), material.material);
  }

  // Adds an instance. Returns false if the mesh must be copied instead.
  bool add_instance(const GltfPrimitive& p, const GltfPose& pose, const std::string& name) {
    const GltfMaterial& material = materials_.get(p.material);
    return instancer_.place({&p, material.material, 0}, p.triangle_count(), pose.world_from_mesh,
                            name, [&] {
                              PlacedBounds in_its_space;
                              return make_mesh(p, {}, name, material, in_its_space);
                            });
  }

  Mesh make_mesh(const GltfPrimitive& p, const GltfPose& pose, const std::string& name,
                 const GltfMaterial& material, PlacedBounds& bounds) {
    std::vector<TextureValue> colors;
    Mesh mesh = make_gltf_mesh(p, pose, material.uv_sets, scene_.warnings, bounds, &colors);
    mesh.name = name;
    mesh.material = material.material;
    painter_.paint(mesh, colors, material.is_textured, material.is_blended);
    const bool is_empty = mesh.triangles.empty();
    const auto warn_of_missing_set = [&](int set) {
      scene_.warnings.add("textured meshes without TEXCOORD_" + std::to_string(set) +
                          " show one texel only");
    };
    if (material.is_textured && mesh.uvs.empty() && !is_empty)
      warn_of_missing_set(material.uv_sets.first);
    if (material.uv_sets.second >= 0 && mesh.uvs_2.empty() && !is_empty)
      warn_of_missing_set(material.uv_sets.second);
    return mesh;
  }

  void add_mesh(const GltfPrimitive& p, const GltfPose& pose, const std::string& name,
                const std::string& node_name) {
    const GltfMaterial& material = materials_.get(p.material);
    Mesh mesh = make_mesh(p, pose, name, material, bounds_);
    const bool is_emissive = !material.emission.is_black();
    // Every emitter counts, even one without triangles, so that names depend on the file alone.
    const std::string light_name =
        node_name.empty() ? "emitter" + std::to_string(counts_.emissive) : node_name;
    if (is_emissive) ++counts_.emissive;
    if (mesh.triangles.empty()) return;
    scene_.meshes.push_back(std::move(mesh));
    if (is_emissive)
      add_mesh_lights(
          scene_, uint32_t(scene_.meshes.size() - 1),
          {light_name, material.emission, material.emission_texture, material.is_two_sided});
  }

  // gltf_schema.h has already checked the reference.
  void add_light(const JsonNode& node, const JsonNode& reference, const Affine& world_from_node) {
    const JsonNode lights = root_.extension(lights_extension)->member("lights");
    const JsonNode light = lights.element(reference.as_index(lights.size(), "lights"));
    std::string name = node.string_or("name", "");
    if (name.empty()) name = light.string_or("name", "");
    if (name.empty()) name = "light" + std::to_string(reference.as_index(lights.size(), "lights"));
    if (auto made = gltf_light(light, world_from_node, name, scene_.warnings))
      scene_.lights.push_back(std::move(*made));
  }

  void add_camera(const JsonNode& node, const JsonNode& reference, const Affine& world_from_node) {
    const JsonNode cameras = root_.member("cameras");
    const JsonNode camera = cameras.element(reference.as_index(cameras.size(), "cameras"));
    std::string name = node.string_or("name", "");
    if (name.empty()) name = camera.string_or("name", "");
    if (name.empty()) name = "camera" + std::to_string(scene_.cameras.size());
    if (auto made = gltf_camera(camera, world_from_node, name, scene_.warnings))
      scene_.cameras.push_back(std::move(*made));
  }

  const JsonNode root_;
  const ImportOptions& options_;
  Scene& scene_;
  PlacedBounds& bounds_;
  GltfBuffers buffers_;
  GltfMaterials materials_;
  GltfBaked baked_;
  VertexPainter painter_;
  MeshInstancer instancer_;
  struct MeshUse {
    std::vector<GltfPrimitive> primitives;
    uint64_t uses = 0;
  };
  std::vector<MeshUse> meshes_;
  GltfPoses poses_;
  GltfNodes nodes_;
  struct Counts {
    size_t emissive = 0;
    uint64_t unshared = 0;  // triangles copied because the instancer refused an instance
  } counts_;
};

}  // namespace

Scene import_gltf(const std::string& path, const ImportOptions& options) {
  return import_recentred(
      [&](Scene& scene, PlacedBounds& bounds) {
        GltfFile file = read_gltf_file(path);
        const JsonDocument document(path, std::move(file.json_text));
        scene.file = path;
        scene.is_photometric = true;
        if (file.is_out_of_order)
          scene.warnings.add("the binary chunk is not the second one; it is read anyway");
        check_gltf_document(document.root(), scene.warnings);
        check_gltf_extensions(document.root(), scene.warnings);
        Importer(document.root(), file, options, scene, bounds).run();
      },
      options.images);
}

}  // namespace troffer
