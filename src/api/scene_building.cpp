// Scene: meshes and spheres from arrays.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "api/scene_impl.h"
#include "api/values.h"
#include "base/error.h"
#include "import/placed_geometry.h"
#include "troffer/scene.h"

namespace troffer::api {

namespace {

std::string called(const char* kind, const std::string& name) {
  return name.empty() ? std::string("a ") + kind : fmt::format("{} '{}'", kind, name);
}

template <class Rows>
void check_finite(const Rows& rows, const std::string& owner, const char* what) {
  for (size_t i = 0; i < rows.size(); ++i)
    for (const auto v : rows[i])
      if (!std::isfinite(v))
        throw UsageError(fmt::format("{}: {} {} is not finite", owner, what, i));
}

void check_mesh(const MeshData& mesh, const std::string& owner) {
  const size_t vertices = mesh.positions.size();
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const uint32_t v : mesh.triangles[i])
      if (v >= vertices)
        throw UsageError(
            fmt::format("{}: triangle {} names vertex {} of {}", owner, i, v, vertices));
  const auto check_length = [&](size_t length, const char* what) {
    if (length != 0 && length != vertices)
      throw UsageError(fmt::format("{}: {} {} for {} positions", owner, length, what, vertices));
  };
  check_length(mesh.normals.size(), "normals");
  check_length(mesh.uvs.size(), "uvs");
  check_finite(mesh.positions, owner, "position");
  check_finite(mesh.normals, owner, "normal");
  check_finite(mesh.uvs, owner, "uv");
  check_finite(mesh.transform, owner, "row of the transform");
  if (mesh.triangles.empty()) throw UsageError(owner + " has no triangles");
}

AnchoredMesh anchored(const MeshData& data) {
  AnchoredMesh made;
  made.mesh.name = data.name;
  std::vector<Vec3d> positions;
  positions.reserve(data.positions.size());
  for (const Point& p : data.positions) positions.push_back(vec(p));
  set_positions(made, positions);
  for (const auto& n : data.normals) made.mesh.normals.emplace_back(n[0], n[1], n[2]);
  for (const auto& uv : data.uvs) made.mesh.uvs.emplace_back(uv[0], uv[1]);
  made.mesh.triangles = data.triangles;
  return made;
}

}  // namespace

uint32_t Scene::Impl::material_for(const std::string& name) {
  if (!name.empty()) return uint32_t(script.material_named(name));
  if (grey) return *grey;
  script.change().materials.emplace_back();
  grey = uint32_t(script.scene().materials.size() - 1);
  return *grey;
}

std::optional<EmissionSpec> Scene::Impl::emission_for(const std::optional<Emission>& emission,
                                                      const std::string& shape) const {
  if (!emission) return std::nullopt;
  EmissionSpec spec;
  spec.name = !emission->name.empty() ? emission->name : shape;
  if (spec.name.empty()) spec.name = fmt::format("emitter{}", script.light_names().size());
  spec.radiance = emitted(emission->radiance, "the radiance of '" + spec.name + "'");
  spec.is_two_sided = emission->is_two_sided;
  spec.texture = texture_for(emission->texture);
  return spec;
}

void Scene::add_mesh(const MeshData& data) {
  check_mesh(data, called("mesh", data.name));
  const std::optional<EmissionSpec> emission = impl_->emission_for(data.emission, data.name);
  const AnchoredMesh mesh = anchored(data);
  const Affine world_from_mesh = affine(data.transform);
  PlacedBounds bounds;
  add_bounds(mesh, world_from_mesh, bounds);
  impl_->append([&] {
    ShapeAttributes look;
    look.material = impl_->material_for(data.material);
    look.emission = emission;
    impl_->script.settle_origin(bounds.box());
    GeometryPlacer(impl_->script.change(), bounds).add_mesh(mesh, world_from_mesh, false, look);
    impl_->script.note_new_lights();
  });
}

void Scene::add_sphere(const SphereData& data) {
  const std::string owner = called("sphere", data.name);
  const Vec3d centre = place(data.centre, owner + ": its centre");
  const double radius = in_range(data.radius, 1e-6, 1e6, owner + ": its radius");
  const std::optional<EmissionSpec> emission = impl_->emission_for(data.emission, data.name);
  PlacedBounds bounds;
  bounds.add_ball(centre, radius);
  impl_->append([&] {
    ShapeAttributes look;
    look.material = impl_->material_for(data.material);
    look.emission = emission;
    impl_->script.settle_origin(bounds.box());
    GeometryPlacer(impl_->script.change(), bounds)
        .add_sphere(Affine(), centre, radius, false, look);
    impl_->script.note_new_lights();
  });
}

}  // namespace troffer::api
