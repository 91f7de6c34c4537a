// The scene: plain data, immutable once built. Importers make it and all methods read it. Positions
// are in metres in world space, relative to Scene::origin.
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
#include "scene/sensor_grid.h"
#include "scene/texture.h"

namespace troffer {

using Triangle = std::array<uint32_t, 3>;

// Triangles with one material. p0, p1, p2 run counterclockwise as seen from the front. Importers
// order vertices by their format's rules for the front.
struct Mesh {
  std::string name;
  std::vector<Vec3> positions;  // metres
  std::vector<Vec3> normals;    // empty, or per vertex: unit shading normals
  std::vector<Vec2> uvs;        // empty, or per vertex: for lights, alpha and most textures
  std::vector<Vec2> uvs_2;      // the same, for textures mapped by second_uv
  std::vector<Triangle> triangles;
  std::vector<int32_t> lights;  // empty (nothing emits), or per triangle
  uint32_t material = 0;
};

// A mesh that is stored once and placed in several positions. scene/mesh_in_world.h makes instances
// and computes their triangles. The front of a triangle stays the front under mirroring transforms,
// where its vertices run clockwise.
struct Instance {
  std::string name;
  uint32_t mesh = 0;       // index into Scene::instanced_meshes
  Affine world_from_mesh;  // invertible
  bool is_mirrored = false;
  float reach = 0;  // metres: coordinate that bounds a ray's rounding error to the mesh and back
  Box bounds;       // bounds of all triangles, in the world
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

// fisheye: the distance from the image's middle is proportional to the angle from `forward`.
enum class CameraKind : uint8_t { perspective, orthographic, fisheye };

// right, up and forward are unit and orthogonal, of either handedness (pbrt mirrors). The image
// plane at distance 1 spans [-1,1] × half_extent along the shorter image axis, or along the
// vertical if fov_is_vertical.
struct Camera {
  std::string name;
  CameraKind kind = CameraKind::perspective;
  Vec3 position, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  float half_extent = 0.5f;  // tan(fov/2); orthographic: half the height in metres; fisheye: fov/2
  bool fov_is_vertical = true;
  bool has_screen_window = false;
  std::array<float, 4> screen_window{-1, 1, -1, 1};  // pbrt: xmin xmax ymin ymax × half_extent
  float lens_radius = 0;                             // metres; 0 is a pinhole
  float focal_distance = 1e6f;                       // metres along forward
  // Metres along forward: anything nearer or farther is invisible. 0: no limit.
  float near_clip = 0, far_clip = 0;
  int width = 0, height = 0;  // image size that the file asks for; 0 if none
  float aspect = 0;           // width / height that the file asks for; 0 if none
};

// Returns the same view as a perspective, at most 90° wide, for uses that know no fisheyes.
Camera without_fisheye(Camera camera);

// A flat mirror that reflects light from sources onto matte surfaces, and that no other ray meets:
// Radiance's `mirror` with an alternate material. What viewers see in its place is other geometry.
struct LightRelay {
  std::vector<Vec3> outline;  // convex
  Vec3 normal;                // unit, on the mirroring side
  Rgb reflectance;            // at every angle
};

struct Scene {
  std::string file;  // as given on the command line
  // Position of our (0,0,0) in the file: zero unless the scene lies far from the file's origin,
  // where floats are coarse. Code that reads or shows users' positions must add it.
  Vec3d origin;
  std::vector<Mesh> meshes;
  std::vector<Mesh> instanced_meshes;  // each in its own space; never emits
  std::vector<Instance> instances;
  std::vector<Sphere> spheres;
  std::vector<Disk> disks;
  std::vector<Material> materials;  // at least one if there is any geometry
  std::vector<Texture> textures;
  std::vector<EnvironmentMap> environments;
  std::vector<LightWeb> webs;
  std::vector<Light> lights;
  std::vector<LightRelay> relays;
  std::vector<Camera> cameras;
  std::vector<SensorGrid> grids;
  std::vector<DynamicGroup> dynamic_groups;
  bool is_photometric = false;  // emission in cd/m² (glTF); else W/(m² sr)
  // Encoded bytes of the images that importers left out, if they were told to leave images out.
  std::optional<uint64_t> skipped_image_bytes;
  WarningLog warnings;
};

size_t triangle_count(const Scene& scene);         // counts every instance
size_t stored_triangle_count(const Scene& scene);  // counts instanced meshes once
Box bounds(const Scene& scene);                    // relative to the scene's origin
Boxd bounds_in_file(const Scene& scene);           // in the file's coordinates

// Returns a copy in which only the lights in `names` emit. Throws UsageError for an unknown name.
Scene with_only_lights(Scene scene, const std::vector<std::string>& names);

// Coverage of a light with a surface at uv, by alpha masks and blends.
inline float coverage(const Scene& scene, const Light& e, const Vec2& uv) {
  return e.is_alpha_masked
             ? coverage(scene.textures, scene.materials[scene.meshes[e.geometry].material], uv)
             : 1.0f;
}

// Radiance that a light with a surface emits from its front (or back) at uv: the mean over the
// footprint, times the coverage at its centre.
inline Rgb emitted_radiance(const Scene& scene, const Light& e, bool is_front,
                            const TexturePlace& uv) {
  if (!is_front && !e.is_two_sided) return Rgb{0};
  const Rgb radiance = e.radiance * coverage(scene, e, uv.uv);
  return e.texture < 0 || radiance.is_black()
             ? radiance
             : radiance * evaluate(scene.textures, uint32_t(e.texture), uv).rgb;
}

}  // namespace troffer
