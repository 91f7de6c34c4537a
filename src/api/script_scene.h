// A scene that changes between pictures: what may be changed, and what is built from it when it is
// next needed. The façade's Scene holds one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/box.h"
#include "daylight/sky_lights.h"
#include "import/import_options.h"
#include "lighting/daylight_options.h"
#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Not for use from several threads at once. Copies share what was built.
class ScriptScene {
 public:
  // Loads a file. Errors: import_scene's.
  ScriptScene(const std::string& file, const ImportOptions& options);
  // An empty scene, to be built.
  ScriptScene(const Vec3& up, bool is_photometric);

  const Scene& scene() const { return scene_; }
  // For changes. Discards what was built. Call note_new_lights() after lights have been appended.
  Scene& change();
  void note_new_lights();

  // Upward direction: of a built scene as it was given, else decide_up()'s.
  Vec3 up() const;
  // Chooses Scene::origin by a box in the file's coordinates, unless positions count from it
  // already.
  void settle_origin(const Boxd& box);

  // Names of lights, each once, in the order of the file.
  std::vector<std::string> light_names() const;
  // Numbers of the lights of that name; UsageError where there is none.
  std::vector<size_t> lights_named(const std::string& name) const;
  // Factor on the radiance that the file or set_radiance() gives: at least 0, finite.
  double dimmer(const std::string& name) const;
  void set_dimmer(const std::string& name, double dimmer);
  // Sets the dimmer of lights whose name fits a pattern (base/wildcard.h); UsageError where none
  // does.
  void dim(const std::string& pattern, double dimmer);
  // Like Light::radiance, undimmed.
  Rgb radiance(const std::string& name) const;
  void set_radiance(const std::string& name, Rgb radiance);

  // Number of the material of that name; UsageError where there is none, or several.
  size_t material_named(const std::string& name) const;

  // Adds a sky; north as make_compass() takes it.
  void add_sky(const SkyRequest& request, double north_deg);
  // Adds light as the program's options do: troffer::add_daylight, with its errors, after which
  // the scene is as it was. Lights keep their dimmers by name.
  void add_light(const DaylightOptions& options);

  // The camera of that name, or the first one for ""; where the scene has none, one that frames it.
  // UsageError where none has this name.
  Camera camera(const std::string& name);

  // Everything that rays need; built where something has changed since the last call.
  std::shared_ptr<const PreparedScene> prepared();
  bool is_prepared() const { return prepared_ != nullptr; }

 private:
  struct Dimmed {
    Rgb radiance;  // at dimmer 1
    double dimmer = 1;
  };
  void apply_dimmers();
  void set_dimmers(const std::vector<size_t>& lights, double dimmer);

  Scene scene_;
  std::optional<Vec3> up_;      // of a built scene
  std::vector<Dimmed> dimmed_;  // by light
  std::shared_ptr<const PreparedScene> prepared_;
};

}  // namespace troffer
