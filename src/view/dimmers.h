// Splits a scene's light into dimmers, and prepares the scene for any setting of them.
//
// Light is linear: the picture under all luminaires is the sum of the pictures under each. The
// scenes differ only in what their lights emit, so they share one tracer. Painter and
// MeasuringQueue render them.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "transport/prepared_scene.h"

namespace troffer {

// One or more luminaires that are dimmed together.
struct Dimmer {
  std::string name;
  std::vector<std::string> lights;  // names of its lights; all lights of these names belong to it
  double power = 0;                 // as in SourceInfo
};

// Factor of each dimmer by channel: brightness times colour.
using DimmerSettings = std::vector<Rgb>;

// Returns one dimmer per light name, in order of appearance. If there are more than `most`, the
// weakest share the last one. Each dimmer needs a copy of the scene's arrays, so large scenes get
// fewer dimmers.
std::vector<Dimmer> dimmers_of(const Scene& scene, size_t most);

constexpr size_t most_dimmers = 16;

// A scene with all its light, under each dimmer alone, and under given settings. The first two are
// prepared on first request and kept. All functions are thread-safe.
class Lighting {
 public:
  explicit Lighting(Scene scene);

  const std::vector<Dimmer>& dimmers() const { return dimmers_; }
  // Properties of the original scene; they need no tracer.
  bool is_photometric() const { return is_photometric_; }
  const std::vector<Camera>& cameras() const { return cameras_; }
  const Vec3d& origin() const { return origin_; }
  const Boxd& bounds() const { return bounds_; }  // in the file's coordinates

  std::shared_ptr<const PreparedScene> whole();
  std::shared_ptr<const PreparedScene> dimmer(size_t number);
  // One factor per dimmer; the result is not kept.
  std::shared_ptr<const PreparedScene> dimmed(const DimmerSettings& settings);
  // Calls look(scene) if whole() has not prepared the scene yet. whole() waits until it returns.
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
