// A scene: immutable data once built, with no algorithms of its own. Positions are in world space,
// counted from Scene::origin.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/log.h"
#include "base/rgb.h"
#include "base/transform.h"
#include "base/units.h"
#include "base/vec.h"
#include "scene/environment_map.h"
#include "scene/light.h"
#include "scene/light_web.h"
#include "scene/material.h"
#include "scene/texture.h"

namespace troffer {

using Triangle = std::array<uint32_t, 3>;

// Triangles that share a material. The front of a triangle is the side from which p0, p1, p2 run
// counterclockwise; importers order vertices so that this is the front by their format's rules.
struct Mesh {
  std::string name;
  std::vector<Vec3> positions;  // metres
  std::vector<Vec3> normals;    // empty, or per vertex: unit shading normals
  std::vector<Vec2> uvs;        // empty, or per vertex: what lights and alpha are looked up by
  std::vector<Vec2> uvs_2;      // the same, for textures mapped by second_uv
  std::vector<Triangle> triangles;
  std::vector<int32_t> lights;  // empty (nothing emits), or per triangle
  uint32_t material = 0;
};

// A mesh that is stored once and stands in several places (scene/mesh_in_world.h makes instances
// and says where their triangles lie). The front of a triangle stays the front under transforms
// that mirror: there its vertices run the other way round.
struct Instance {
  std::string name;
  uint32_t mesh = 0;       // of Scene::instanced_meshes
  Affine world_from_mesh;  // invertible
  bool is_mirrored = false;
  float reach = 0;  // metres: of what coordinates a ray's rounding is, taken to the mesh and back
  Box bounds;       // of all triangles, in the world
};

// A whole sphere; its front is outside unless is_inside_out.
struct Sphere {
  Vec3 centre;
  float radius = 1;
  bool is_inside_out = false;
  uint32_t material = 0;
  int32_t light = no_light;
};

// A whole flat disk; its front is the side the normal points to.
struct Disk {
  Vec3 centre;
  Vec3 normal{0, 0, 1};  // unit
  float radius = 1;
  uint32_t material = 0;
  int32_t light = no_light;
};

enum class CameraKind : uint8_t { perspective, orthographic };

// right, up, forward are unit and orthogonal, of either handedness (pbrt mirrors).
// The image plane at distance 1 spans [-1,1] × half_extent along the shorter image axis, or along
// the vertical where fov_is_vertical.
struct Camera {
  std::string name;
  CameraKind kind = CameraKind::perspective;
  Vec3 position, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  float half_extent = 0.5f;  // tan(fov/2); orthographic: half the height in metres
  bool fov_is_vertical = true;
  bool has_screen_window = false;
  std::array<float, 4> screen_window{-1, 1, -1, 1};  // pbrt: xmin xmax ymin ymax × half_extent
  float lens_radius = 0;                             // metres; 0 = pinhole
  float focal_distance = 1e6f;                       // metres along forward
  // Metres along forward: what lies nearer or farther is not seen. 0: no limit.
  float near_clip = 0, far_clip = 0;
  int width = 0, height = 0;  // image size the file asks for; 0 = it does not say
  float aspect = 0;           // width / height the file asks for; 0 = it does not say
};

struct Scene {
  std::string file;  // as given on the command line
  // Where the file has what is (0,0,0) here: zero, unless the scene lies far from the file's
  // origin, where floats are coarse. Whoever takes positions from users or shows them adds it.
  Vec3d origin;
  std::vector<Mesh> meshes;
  std::vector<Mesh> instanced_meshes;  // each in a space of its own; nothing of them emits
  std::vector<Instance> instances;
  std::vector<Sphere> spheres;
  std::vector<Disk> disks;
  std::vector<Material> materials;  // at least one if there is any geometry
  std::vector<Texture> textures;
  std::vector<EnvironmentMap> environments;
  std::vector<LightWeb> webs;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  bool is_photometric = false;  // emission in cd/m² (glTF); else W/(m² sr)
  // Where importers were to leave images out: bytes of those that there would have been, encoded.
  std::optional<uint64_t> left_out_image_bytes;
  WarningLog warnings;
};

size_t triangle_count(const Scene& scene);  // those of every instance too
size_t stored_triangle_count(const Scene& scene);
Box bounds(const Scene& scene);           // from the scene's origin
Boxd bounds_in_file(const Scene& scene);  // in the file's coordinates

// A copy of which only lights named in `names` emit; UsageError names one that does not exist.
Scene with_only_lights(Scene scene, const std::vector<std::string>& names);

// The share of rays that meet a light with a surface at uv: alpha masks and blends.
inline float coverage(const Scene& scene, const Light& e, const Vec2& uv) {
  return e.is_alpha_masked
             ? coverage(scene.textures, scene.materials[scene.meshes[e.geometry].material], uv)
             : 1.0f;
}

// Emission of a light that has a surface towards a viewer on its front (or back), where the surface
// has texture coordinates uv: the mean over a footprint, whose middle decides about holes. Where
// alpha blends, the mean over rays that meet it and rays that do not.
inline Rgb emitted_radiance(const Scene& scene, const Light& e, bool is_front,
                            const TexturePlace& uv) {
  if (!is_front && !e.is_two_sided) return Rgb{0};
  const Rgb radiance = e.radiance * coverage(scene, e, uv.uv);
  return e.texture < 0 || radiance.is_black()
             ? radiance
             : radiance * evaluate(scene.textures, uint32_t(e.texture), uv).rgb;
}

}  // namespace troffer
