#include "import/pbrt/pbrt_place.h"

#include <cmath>

#include "import/emissive.h"
#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/placed_geometry.h"
#include "import/tessellate.h"

namespace troffer {

namespace {

bool is_similarity(const Affine& t) {
  return keeps_circles(t, 0, 1) && keeps_circles(t, 1, 2) && keeps_circles(t, 2, 0);
}

// Cost in triangles. Vertices without triangles cost memory too.
size_t cost_of(const Mesh& mesh) {
  return std::max(mesh.triangles.size(), mesh.positions.size() / 3);
}

// Number of triangles whose (u,v) run clockwise on their front.
size_t count_turned(const Mesh& mesh) {
  if (mesh.uvs.empty()) return 0;
  size_t n = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec2 a = mesh.uvs[t[1]] - mesh.uvs[t[0]], b = mesh.uvs[t[2]] - mesh.uvs[t[0]];
    n += a.x * b.y - a.y * b.x < 0 ? 1 : 0;
  }
  return n;
}

// Mean luminance of an image. pbrt divides a given power by it.
double mean_luminance(const Scene& scene, int32_t texture) {
  const Texture& t = scene.textures[size_t(texture)];
  if (t.kind != TextureKind::image) return luminance(t.value);
  double sum = 0;
  for (int y = 0; y < t.height; ++y)
    for (int x = 0; x < t.width; ++x)
      sum += double(luminance(
          evaluate(scene.textures, uint32_t(texture),
                   Vec2{(float(x) + 0.5f) / float(t.width), (float(y) + 0.5f) / float(t.height)})
              .rgb));
  return sum / (double(t.width) * double(t.height));
}

}  // namespace

void PbrtPlacer::spend(size_t triangles, const PbrtPlace& place) {
  cost_ += std::max(triangles, least_shape_cost);
  if (cost_ > max_scene_triangles)
    fail_at(place, "the scene has too much geometry (over " +
                       std::to_string(max_scene_triangles / 1'000'000) + " million triangles)");
}

void PbrtPlacer::count_waiting(const PbrtShape& shape, const PbrtPlace& at) {
  spend(shape.mesh ? cost_of(shape.mesh->mesh) : 1, at);
}

void PbrtPlacer::place(const PbrtShape& shape, const PbrtPlace& at) {
  const bool is_flipped = shape.is_reversed != shape.world_from_object.swaps_handedness();
  place({shape, shape.world_from_object, is_flipped, shape.light != nullptr, false, at});
}

void PbrtPlacer::place_instance(const PbrtShape& shape, const Affine& world_from_instance,
                                const PbrtPlace& at) {
  const bool is_flipped = shape.is_reversed != shape.world_from_object.swaps_handedness();
  place({shape, world_from_instance * shape.world_from_object, is_flipped, false, true, at});
}

void PbrtPlacer::place(Placing placing) {
  placing.world_from_object.translation -= scene_.origin;
  if (placing.shape.material->is_interface()) {
    scene_.warnings.add("shape with the interface material is left out");
    if (placing.is_emitting) skip_light();
    return;
  }
  const PbrtShape& shape = placing.shape;
  if (shape.kind == PbrtShapeKind::mesh) {
    place_mesh(placing, *shape.mesh, shape.is_quadric);
  } else if (shape.kind == PbrtShapeKind::sphere) {
    if (is_similarity(placing.world_from_object) && !needs_triangles(placing))
      place_sphere(placing);
    else
      place_mesh(placing,
                 {tessellate_sphere(shape.radius, -shape.radius, shape.radius, 2 * pi), {}}, true);
  } else if (keeps_circles(placing.world_from_object, 0, 1) && !needs_triangles(placing)) {
    place_disk(placing);
  } else {
    place_mesh(placing, {tessellate_disk(shape.height, shape.radius, 0, 2 * pi), {}}, true);
  }
}

// Exact spheres and disks have no (u,v) and no holes. Emitting ones always stay exact.
bool PbrtPlacer::needs_triangles(const Placing& placing) {
  if (placing.is_emitting) return false;
  const Material& m = scene_.materials[material_of(placing)];
  return is_textured(m) || m.is_alpha_masked;
}

// True if the normals point the other way. ReverseOrientation turns a mesh's own normals. A
// mirroring transform also turns the computed normals of quadrics.
bool PbrtPlacer::are_normals_turned(const Placing& placing, bool is_quadric) {
  return is_quadric ? placing.is_flipped_quadric : placing.shape.is_reversed;
}

uint32_t PbrtPlacer::material_of(const Placing& placing) {
  PbrtMaterial& material = *placing.shape.material;
  return materials_.index_of_copy(material, placing.shape.alpha, placing.shape.absorption);
}

Light PbrtPlacer::next_light(const PbrtAreaLight& light, double area) {
  Light e;
  e.name = "emitter" + std::to_string(lights_++);
  e.is_two_sided = light.is_two_sided;
  e.radiance = light.radiance;
  if (light.power > 0 && area > 0) {
    // A diffuse source of radiance L emits pi L per area and side.
    e.radiance *= float(light.power / (pi * area * (light.is_two_sided ? 2 : 1)));
  }
  if (!is_finite(e.radiance)) {
    scene_.warnings.add("area light whose radiance is too large for a number: does not emit");
    e.radiance = Rgb{0};
  }
  return e;
}

void PbrtPlacer::place_sphere(const Placing& placing) {
  spend(1, placing.place);
  Sphere sphere;
  sphere.centre = Vec3(placing.world_from_object.translation);
  const double r = placing.shape.radius * length(placing.world_from_object.columns[0]);
  bounds_.add_ball(placing.world_from_object.translation, r);
  sphere.radius = float(r);
  sphere.is_inside_out = placing.is_flipped_quadric;
  if (!is_finite(sphere.centre) || !(sphere.radius > 0) || !std::isfinite(sphere.radius)) {
    scene_.warnings.add("sphere that is not finite or has no area is left out");
    if (placing.is_emitting) skip_light();
    return;
  }
  sphere.material = material_of(placing);
  if (placing.is_emitting && is_textured(scene_.materials[sphere.material]))
    scene_.warnings.add("sphere with a texture that emits: shown with its value at (0,0)");
  const auto geometry = uint32_t(scene_.spheres.size());
  if (placing.is_emitting) {
    if (!placing.shape.light->image.empty())
      scene_.warnings.add("image of the emission of a sphere is not supported: ignored");
    Light e = next_light(*placing.shape.light, 4 * pi * r * r);
    e.kind = LightKind::sphere;
    e.geometry = geometry;
    if (!e.radiance.is_black()) {
      sphere.light = int32_t(scene_.lights.size());
      scene_.lights.push_back(std::move(e));
    }
  }
  scene_.spheres.push_back(sphere);
}

void PbrtPlacer::place_disk(const Placing& placing) {
  spend(1, placing.place);
  const Affine& t = placing.world_from_object;
  Disk disk;
  const Vec3d centre = t.point({0, 0, placing.shape.height});
  disk.centre = Vec3(centre);
  const double r = placing.shape.radius * length(t.columns[0]);
  bounds_.add_ball(centre, r);
  disk.radius = float(r);
  // Columns 0 and 1 are not parallel (keeps_circles), so their cross product is not zero.
  const Vec3d axis = normalize(cross(t.columns[0], t.columns[1]));
  const bool is_turned = placing.is_flipped_quadric != t.swaps_handedness();
  disk.normal = Vec3(is_turned ? -axis : axis);
  if (!is_finite(disk.centre) || !is_finite(disk.normal) || !(disk.radius > 0) ||
      !std::isfinite(disk.radius)) {
    scene_.warnings.add("disk that is not finite or has no area is left out");
    if (placing.is_emitting) skip_light();
    return;
  }
  disk.material = material_of(placing);
  if (placing.is_emitting && is_textured(scene_.materials[disk.material]))
    scene_.warnings.add("disk with a texture that emits: shown with its value at (0,0)");
  const auto geometry = uint32_t(scene_.disks.size());
  if (placing.is_emitting) {
    if (!placing.shape.light->image.empty())
      scene_.warnings.add("image of the emission of a disk is not supported: ignored");
    Light e = next_light(*placing.shape.light, pi * r * r);
    e.kind = LightKind::disk;
    e.geometry = geometry;
    if (!e.radiance.is_black()) {
      disk.light = int32_t(scene_.lights.size());
      scene_.lights.push_back(std::move(e));
    }
  }
  scene_.disks.push_back(disk);
}

void PbrtPlacer::set_normal_map(Mesh& mesh) {
  const Material& m = scene_.materials[mesh.material];
  if (m.normal_texture < 0 || scene_.textures[size_t(m.normal_texture)].kind != TextureKind::image)
    return;
  const size_t turned = count_turned(mesh), all = mesh.triangles.size();
  if (turned > 0 && turned < all)
    scene_.warnings.add(
        "a normal map on triangles with mirrored and unmirrored texture coordinates: its y follows "
        "the larger part");
  if (2 * turned > all) mesh.material = materials_.with_flipped_normal_map(mesh.material);
}

// Places an instance as a shared mesh. Returns false if the mesh has to be copied instead.
bool PbrtPlacer::place_shared(const Placing& placing, const AnchoredMesh& local, bool is_quadric) {
  const PbrtShape& shape = placing.shape;
  const size_t triangles = local.mesh.triangles.size();
  const auto make = [&] {
    spend(triangles, placing.place);
    Mesh mesh = transformed({local.mesh, {}}, Affine(), are_normals_turned(placing, is_quadric),
                            shape.is_reversed);
    clean_mesh(mesh, scene_.warnings);
    mesh.material = material_of(placing);
    if (is_textured(scene_.materials[mesh.material])) add_default_uvs(mesh);
    set_normal_map(mesh);
    return mesh;
  };
  if (!instancer_.place({&shape, material_of(placing), 0}, triangles,
                        placing.world_from_object * Affine::translate(local.anchor), "", make))
    return false;
  spend(1, placing.place);
  placed_triangles_ += triangles;
  if (placed_triangles_ > max_placed_triangles) fail_at(placing.place, too_many_by_instances());
  return true;
}

void PbrtPlacer::place_mesh(const Placing& placing, const AnchoredMesh& local, bool is_quadric) {
  if (placing.is_instance && place_shared(placing, local, is_quadric)) return;
  spend(cost_of(local.mesh), placing.place);
  const Affine& t = placing.world_from_object;
  const PbrtShape& shape = placing.shape;
  add_bounds(local, t, bounds_);
  Mesh mesh = transformed(local, t, are_normals_turned(placing, is_quadric),
                          shape.is_reversed != t.swaps_handedness());
  clean_mesh(mesh, scene_.warnings);
  if (mesh.triangles.empty()) {
    if (placing.is_emitting) {
      scene_.warnings.add("area light without area is left out");
      skip_light();
    }
    return;
  }
  mesh.material = material_of(placing);
  const bool has_image = placing.is_emitting && !shape.light->image.empty();
  if (has_image || is_textured(scene_.materials[mesh.material])) add_default_uvs(mesh);
  set_normal_map(mesh);
  const auto index = uint32_t(scene_.meshes.size());
  scene_.meshes.push_back(std::move(mesh));
  if (!placing.is_emitting) return;

  Light e = next_light(*shape.light, area_of(scene_.meshes[index]));
  EmissionSpec spec{e.name, e.radiance, no_texture, e.is_two_sided};
  if (has_image) {
    spec.texture = materials_.textures.image(shape.light->image, true, WrapMode::clamp);
    const double mean = shape.light->power > 0 ? mean_luminance(scene_, spec.texture) : 1;
    if (mean > 1e-9) spec.radiance *= float(1 / mean);  // otherwise the image is (nearly) black
  }
  add_mesh_lights(scene_, index, spec);
}

}  // namespace troffer
