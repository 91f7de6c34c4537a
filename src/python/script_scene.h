// A scene as a script holds it: it can be changed between renderings, and is prepared again when
// needed.
// The Python bindings use it. Units are those of Scene.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "daylight/sky_lights.h"
#include "import/import_options.h"
#include "lighting/daylight_options.h"
#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A scene, its dimmers, and its prepared form. Not thread-safe.
class ScriptScene {
 public:
  // Throws the errors of import_scene().
  ScriptScene(const std::string& file, const ImportOptions& options);

  const Scene& scene() const { return scene_; }
  // Returns the scene for changes. The prepared scene is discarded.
  Scene& change();

  // Returns the names of lights, each once, in the order of the file.
  std::vector<std::string> light_names() const;
  // Returns the indices of the lights of that name. Throws UsageError if there is none.
  std::vector<size_t> lights_named(const std::string& name) const;
  // Factor on the light of the file, or on the radiance of the last set_radiance(): finite, at
  // least 0.
  double dimmer(const std::string& name) const;
  void set_dimmer(const std::string& name, double dimmer);
  // Radiance as in Light::radiance, without the dimmer.
  Rgb radiance(const std::string& name) const;
  void set_radiance(const std::string& name, Rgb radiance);

  // Returns the index of the material of that name. Throws UsageError if there is none, or several.
  size_t material_named(const std::string& name) const;

  // Adds a sky to a scene with the given up direction; `north_deg` as in make_compass().
  void add_sky(const SkyRequest& request, Vec3 up, double north_deg);
  // Adds light by the program's options, with the errors of troffer::add_daylight(). If it throws,
  // the scene is unchanged. Lights keep their dimmers by name.
  void add_light(const DaylightOptions& options);

  // Returns the camera of that name, or for "" the first one, or one that frames a scene without
  // cameras. Throws UsageError for an unknown name.
  Camera camera(const std::string& name);

  // Returns the prepared scene. It is built again if anything has changed since the last call.
  std::shared_ptr<const PreparedScene> prepared();

 private:
  struct Dimmed {
    Rgb radiance;  // undimmed
    double dimmer = 1;
  };
  void apply_dimmers();

  Scene scene_;
  std::vector<Dimmed> dimmed_;  // by light
  std::shared_ptr<const PreparedScene> prepared_;
};

// Runs work(stop) on another thread while this one calls look() twenty times a second, and once
// more at the end. If look() throws, `stop` is set and the exception is rethrown after the work has
// ended. Otherwise the work's exception is rethrown. The work must check the flag.
void run_watched(const std::function<void(const StopFlag& stop)>& work,
                 const std::function<void()>& look);

}  // namespace troffer
