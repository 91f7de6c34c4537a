// The luminaires of a scene that can be dimmed one by one, and the scene under any setting of them.
//
// Light is linear: the picture under all luminaires is the sum of the pictures under each. All
// scenes here share one tracer, because they differ only in what their lights emit.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct Dimmer {
  std::string name;
  std::vector<std::string> lights;  // all lights of these names
  double power = 0;                 // as SourceInfo
};

// One factor per dimmer and channel: brightness times colour.
using DimmerSettings = std::vector<Rgb>;

// One dimmer for every name of lights, in order of appearance. Beyond `most`, the weakest share the
// last one. Each dimmer takes a copy of the scene's arrays, so large scenes get fewer.
std::vector<Dimmer> dimmers_of(const Scene& scene, size_t most);

constexpr size_t most_dimmers = 16;

// A scene with all its light, under each dimmer alone, and under given settings. The first two are
// made on first request and kept. Every function may be called from any thread.
class Lighting {
 public:
  explicit Lighting(Scene scene);

  const std::vector<Dimmer>& dimmers() const { return dimmers_; }
  // What needs no tracer: of the scene as it came.
  bool is_photometric() const { return is_photometric_; }
  const std::vector<Camera>& cameras() const { return cameras_; }
  const Vec3d& origin() const { return origin_; }
  const Boxd& bounds() const { return bounds_; }  // in the file's coordinates

  std::shared_ptr<const PreparedScene> whole();
  std::shared_ptr<const PreparedScene> dimmer(size_t number);
  // One factor per dimmer; not kept.
  std::shared_ptr<const PreparedScene> dimmed(const DimmerSettings& settings);
  // Calls look(scene) where whole() has not been made yet, which then waits.
  void before_preparing(const std::function<void(const Scene&)>& look);

 private:
  std::shared_ptr<const PreparedScene> scaled(const std::shared_ptr<const PreparedScene>& all,
                                              const DimmerSettings& settings) const;

  std::unique_ptr<Scene> scene_;
  const std::vector<Dimmer> dimmers_;
  const bool is_photometric_;
  const std::vector<Camera> cameras_;
  const Vec3d origin_;
  const Boxd bounds_;
  std::mutex mutex_;
  std::shared_ptr<const PreparedScene> whole_;
  std::vector<std::shared_ptr<const PreparedScene>> by_dimmer_;
};

}  // namespace troffer
