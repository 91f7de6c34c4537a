// A scene that changes between pictures. It keeps dimmers by light and builds the acceleration
// structures when they are next needed. The public class Scene holds one. Units are those of the
// renderer's Scene.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "daylight/sky_lights.h"
#include "import/import_options.h"
#include "lighting/daylight_options.h"
#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Not thread-safe. Copies share the prepared scene until one of them changes.
class ScriptScene {
 public:
  // Loads a file. Throws what import_scene() throws.
  ScriptScene(const std::string& file, const ImportOptions& options);
  // Makes an empty scene, to be built.
  ScriptScene(const Vec3& up, bool is_photometric);

  const Scene& scene() const { return scene_; }
  // Returns the scene for changes and discards the prepared scene. Call note_new_lights() after
  // appending lights.
  Scene& change();
  // Options that the file was loaded with.
  const ImportOptions& import_options() const { return options_; }
  // False while surfaces and materials are those of the file.
  bool is_changed() const { return is_changed_; }
  void note_new_lights();
  // Calls `add`, which appends to the scene. If it throws, the scene is as it was.
  template <class F>
  void append(const F& add) {
    Extent before = extent();
    try {
      add();
    } catch (...) {
      restore(std::move(before));
      throw;
    }
  }

  // Upward direction: the given one for a built scene, that of decide_up() for a file.
  Vec3 up() const;
  // Chooses Scene::origin for a box in the caller's coordinates, m. Does nothing if the scene has
  // positions already, or for a file.
  void settle_origin(const Boxd& box);

  // Names of lights, each once, in the order of Scene::lights.
  std::vector<std::string> light_names() const;
  // Indices of the lights of that name. Throws UsageError if there are none.
  std::vector<size_t> lights_named(const std::string& name) const;
  // Factor on the radiance of the file or of set_radiance(); finite, at least 0.
  double dimmer(const std::string& name) const;
  void set_dimmer(const std::string& name, double dimmer);
  // Sets the dimmer of lights whose name fits a pattern (base/wildcard.h). Throws UsageError if
  // none does.
  void dim(const std::string& pattern, double dimmer);
  // Light::radiance at dimmer 1.
  Rgb radiance(const std::string& name) const;
  void set_radiance(const std::string& name, Rgb radiance);

  // Index of the material of that name. Throws UsageError if there is none or several.
  size_t material_named(const std::string& name) const;

  // Adds a sky. make_compass() defines `north_deg`.
  void add_sky(const SkyRequest& request, double north_deg);
  // Adds light by troffer::add_daylight() and throws what it throws; the scene is then unchanged.
  // Lights keep their dimmers by name.
  void add_light(const DaylightOptions& options);

  // Returns the camera of that name; for "" the first one, or one that frames the scene if it has
  // none. Throws UsageError for an unknown name.
  Camera camera(const std::string& name);

  // Returns the scene with everything that rays need. Builds it if the scene changed since the last
  // call. Throws UsageError if the scene is empty.
  std::shared_ptr<const PreparedScene> prepared();
  bool is_prepared() const { return prepared_ != nullptr; }

 private:
  struct Dimmed {
    Rgb radiance, ground;  // at dimmer 1; ground: of a sky
    double dimmer = 1;
  };
  // Sizes of all lists of the scene, and what else appending changes.
  struct Extent {
    Vec3d origin;
    size_t meshes, instanced_meshes, instances, spheres, disks, materials, textures, environments,
        webs, lights, cameras;
    WarningLog warnings;
  };
  Extent extent() const;
  void restore(Extent&& before);  // does not throw
  void apply_dimmers();
  void set_dimmers(const std::vector<size_t>& lights, double dimmer);

  Scene scene_;
  ImportOptions options_;
  bool is_changed_ = false;
  std::optional<Vec3> up_;      // empty for a scene from a file
  std::vector<Dimmed> dimmed_;  // one per light of scene_
  std::shared_ptr<const PreparedScene> prepared_;
};

}  // namespace troffer
