// A scene as a script holds it: what may be changed between renderings, and what is built from it
// when it is next needed.
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

// Not for use from several threads at once.
class ScriptScene {
 public:
  // Errors: import_scene's.
  ScriptScene(const std::string& file, const ImportOptions& options);

  const Scene& scene() const { return scene_; }
  // For changes; what was built before is built anew.
  Scene& change();

  // Names of lights, each once, in the order of the file.
  std::vector<std::string> light_names() const;
  // Numbers of the lights of that name; UsageError where there is none.
  std::vector<size_t> lights_named(const std::string& name) const;
  // What they send, over what the file says (or what set_radiance said last): at least 0, finite.
  double dimmer(const std::string& name) const;
  void set_dimmer(const std::string& name, double dimmer);
  // As Light::radiance, undimmed.
  Rgb radiance(const std::string& name) const;
  void set_radiance(const std::string& name, Rgb radiance);

  // Number of the material of that name; UsageError where there is none, or several.
  size_t material_named(const std::string& name) const;

  // Adds a sky; to a scene whose up is `up`, as `north_deg` says (make_compass).
  void add_sky(const SkyRequest& request, Vec3 up, double north_deg);
  // Light as the program's options bring it: troffer::add_daylight, with its errors, after which
  // the scene is as it was. Lights keep their dimmers by name.
  void add_light(const DaylightOptions& options);

  // The camera of that name, or the first one for ""; where the scene has none, one that frames it.
  // UsageError where none has this name.
  Camera camera(const std::string& name);

  // What rays meet; built where something has changed since the last call.
  std::shared_ptr<const PreparedScene> prepared();

 private:
  struct Dimmed {
    Rgb radiance;  // whole
    double dimmer = 1;
  };
  void apply_dimmers();

  Scene scene_;
  std::vector<Dimmed> dimmed_;  // by light
  std::shared_ptr<const PreparedScene> prepared_;
};

// Runs work(stop) on a thread of its own while this one calls look() twenty times a second, and
// once more at the end. What look() throws sets `stop` and is thrown once the work has ended; else
// what the work throws. The work must look at the flag.
void run_watched(const std::function<void(const StopFlag& stop)>& work,
                 const std::function<void()>& look);

}  // namespace troffer
