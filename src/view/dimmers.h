// The luminaires of a scene that can be dimmed one by one, and the scene by the light of one alone.
//
// Light is linear: a picture by all of them is the sum of pictures by each.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "integrate/prepared_scene.h"

namespace troffer {

struct Dimmer {
  std::string name;
  std::vector<std::string> lights;  // all lights of these names
  double power = 0;                 // as SourceInfo
};

// One for every name of lights, in order of appearance; of more than `most` the weakest share one,
// the last. Copies of the scene are made for each, so scenes of many triangles get fewer.
std::vector<Dimmer> dimmers_of(const Scene& scene, size_t most);

constexpr size_t most_dimmers = 16;

// A scene with all its light, and by each dimmer alone; each is made when it is first asked for, by
// any thread.
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
  // Calls look(scene) where whole() has not been made yet, which then waits.
  void before_preparing(const std::function<void(const Scene&)>& look);

 private:
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
