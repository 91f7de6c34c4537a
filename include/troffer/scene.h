/// @file
/// Scenes: loaded from files or built from arrays. Scenes can change between pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "troffer/error.h"
#include "troffer/image.h"
#include "troffer/light.h"
#include "troffer/material.h"
#include "troffer/types.h"

namespace troffer::api {

/// Options for loading a file.
struct LoadOptions {
  std::optional<std::string> variant{};    ///< glTF: name of the material variant
  std::optional<double> time{};            ///< glTF: seconds into the animation; none: at rest
  std::optional<std::string> animation{};  ///< glTF: name of the animation; none: the first
  double emission_scale = 1;               ///< factor on the emission of surfaces in the file
  bool shows_baked = false;                ///< glTF: show the light that `troffer bake` wrote
};

/// Conventions of a scene that is built from arrays.
struct SceneOptions {
  Point up{0, 0, 1};           ///< upward direction
  bool is_photometric = true;  ///< light in cd/m², cd and lx; if false, in W/(m² sr), W/sr, W/m²
};

/// A mesh of triangles. The front of a triangle is the side that its normals point to. Without
/// normals it is the side from which the vertices run counterclockwise.
struct MeshData {
  std::string name{};                                     ///< may be empty
  std::vector<Point> positions{};                         ///< per vertex, metres
  std::vector<std::array<std::uint32_t, 3>> triangles{};  ///< vertex numbers, from 0
  std::vector<std::array<float, 3>> normals{};            ///< none, or one per vertex
  std::vector<std::array<float, 2>> uvs{};                ///< none, or one per vertex
  std::string material{};                                 ///< name; empty: matte grey
  Transform transform = identity;                         ///< from mesh to world
  std::optional<Emission> emission{};                     ///< none: emits nothing
};

/// A sphere; its front is outside.
struct SphereData {
  std::string name{};                  ///< may be empty
  Point centre{};                      ///< metres
  double radius = 1;                   ///< metres
  std::string material{};              ///< name; empty: matte grey
  std::optional<Emission> emission{};  ///< none: emits nothing
};

/// A camera by its position and target.
struct LookAt {
  Point eye{};                ///< metres
  Point target{};             ///< metres
  std::optional<Point> up{};  ///< none: the scene's
  double fov = 60;         ///< field of view over the picture's shorter side, 0.01 to 179 degrees
  double lens_radius = 0;  ///< metres; 0: everything is sharp
  double focal_distance = 0;  ///< metres; 0: distance of the target
};

/// A camera, made by Scene::look_at() or Scene::camera(). Copies are cheap.
class Camera {
 public:
  struct Impl;
  /// For the library's own use.
  explicit Camera(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  /// Name in the scene; empty for a camera of look_at().
  const std::string& name() const;
  /// For the library's own use.
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

/// A scene. Only one thread may use it at a time. Changes take effect in the next picture or
/// measurement, which first rebuilds what depends on them. If a function throws, the scene is
/// unchanged.
class Scene {
 public:
  /// Makes an empty scene, to be built.
  explicit Scene(const SceneOptions& options = {});
  /// Makes an independent copy.
  Scene(const Scene& other);
  /// Moves `other`, which may only be assigned to or destroyed afterwards.
  Scene(Scene&& other) noexcept;
  /// Replaces the scene by an independent copy.
  Scene& operator=(const Scene& other);
  /// Moves `other`, which may only be assigned to or destroyed afterwards.
  Scene& operator=(Scene&& other) noexcept;
  ~Scene();

  /// Loads .gltf, .glb, .pbrt, .obj, .stl, .ply, .xml (Mitsuba) or .rad.
  /// @throws InputError with file, line and column if the file cannot be used
  /// @throws UsageError for options that the format does not have
  static Scene load(const std::string& path, const LoadOptions& options = {});

  /// @name Facts
  /// @{

  /// Path that was given to load(); empty for a built scene.
  const std::string& file() const;
  /// Warnings about the scene, one sentence each.
  std::vector<std::string> warnings() const;
  /// Returns true if emission is in cd/m² (glTF), false if it is in W/(m² sr).
  bool is_photometric() const;
  /// Number of triangles.
  std::size_t triangle_count() const;
  /// Bounding box of all surfaces: the lower and the upper corner, metres.
  std::pair<Point, Point> bounds() const;
  /// Upward direction. For a loaded scene it follows from the format or from hints in the file.
  Point up() const;
  /// Names of the cameras.
  std::vector<std::string> camera_names() const;
  /// Names of the lights, each once.
  std::vector<std::string> light_names() const;
  /// Names of all materials, by number; they may repeat.
  std::vector<std::string> material_names() const;
  /// @}

  /// @name Building
  /// @{

  /// Adds a texture.
  /// @throws UsageError if sizes do not fit or a number is not finite
  TextureId add_texture(const TextureImage& image);
  /// Adds a material under a new name. Returns its number.
  /// @throws UsageError for a name that is taken and for values outside their ranges
  std::size_t add_material(const std::string& name, const Material& material);
  /// Adds a mesh. Triangles without area are left out with a warning.
  /// @throws UsageError for vertices, materials or textures that do not exist, for numbers that
  ///   are not finite, and for normals or uvs that are not one per position
  void add_mesh(const MeshData& mesh);
  /// Adds a sphere. @throws UsageError as add_mesh()
  void add_sphere(const SphereData& sphere);
  /// Adds a point light. @throws UsageError for values that are negative or not finite
  void add_light(const PointLight& light);
  /// Adds a spot light. @throws UsageError for values that are negative or not finite
  void add_light(const SpotLight& light);
  /// Adds a distant light. @throws UsageError for values that are negative or not finite
  void add_light(const DistantLight& light);
  /// Adds a measured luminaire.
  /// @throws InputError if the file cannot be used
  /// @throws UsageError for values outside their ranges
  void add_light(const Luminaire& luminaire);
  /// Adds a sky. @throws UsageError for an unknown kind, or if the kind needs a sun that is missing
  void add_light(const Sky& sky);
  /// Adds light as options of the program do. Lights keep their dimmers by name.
  /// @throws UsageError for invalid values
  /// @throws InputError if a file cannot be used
  void add_light(const AddedLight& light);
  /// Adds the light "environment": a latitude-longitude image of the surroundings. Its middle
  /// column lies in the east, and columns further right lie clockwise, seen from above. `rotation`
  /// turns it clockwise, in degrees.
  /// @throws UsageError for numbers that are negative or not finite
  void add_environment(const Image& image, double scale = 1, double rotation = 0);
  /// Adds a camera under a name. @throws UsageError for a name that is taken
  void add_camera(const std::string& name, const LookAt& view);
  /// @}

  /// @name Changing
  /// @{

  /// Returns facts about the lights of one name. @throws UsageError if there are none
  LightInfo light(const std::string& name) const;
  /// Sets the dimmer of the lights of one name: the factor on their light, at least 0.
  /// @throws UsageError if there are none, or for an invalid factor
  void set_dimmer(const std::string& name, double dimmer);
  /// Sets the radiance of the lights of one name, before their dimmer: W/(m² sr) or cd/m², at least
  /// 0. For point and spot lights it is the intensity, for distant lights the irradiance. For
  /// images, skies and measured luminaires it is a factor.
  /// @throws UsageError if there are none, or for an invalid radiance
  void set_radiance(const std::string& name, const Color& radiance);
  /// Sets the dimmer of all lights whose name fits a pattern. '*' stands for any characters.
  /// @throws UsageError if no name fits
  void dim(const std::string& pattern, double factor);
  /// Returns the number of the material of that name.
  /// @throws UsageError if there is none or several
  std::size_t material(const std::string& name) const;
  /// Reflectance of a material, without its texture.
  Color base_color(std::size_t material) const;
  /// Sets the reflectance, 0 to 1.
  void set_base_color(std::size_t material, const Color& color);
  /// A number of a material, without its texture.
  double number(std::size_t material, MaterialNumber which) const;
  /// Sets a number of a material. @throws UsageError outside its range
  void set_number(std::size_t material, MaterialNumber which, double value);
  /// @}

  /// @name Cameras
  /// @{

  /// Returns the camera of that name. An empty name means the first camera, or one
  /// that frames the scene if it has none.
  /// @throws UsageError if no camera has the name
  Camera camera(const std::string& name = "");
  /// Makes a camera from a position and a target.
  /// @throws UsageError for values outside their ranges, or if the eye is at the target
  Camera look_at(const LookAt& view) const;
  /// @}

  struct Impl;
  /// For the library's own use.
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace troffer::api
