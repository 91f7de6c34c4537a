// Regions in which the scenes of a year's states differ: boxes around surfaces that only some of
// the scenes have. A straight ray that meets no box of a region meets the same surfaces in the
// scenes of that region and in the scene that they are compared with. Lengths are in metres.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "scene/scene.h"
#include "trace/ray.h"

namespace troffer {

// Surfaces of a scene, by what they look like to rays.
class SceneSurfaces {
 public:
  explicit SceneSurfaces(const Scene& scene);
  // Returns boxes around all surfaces that only one of both scenes has, or nothing if the scenes
  // cannot be compared.
  std::optional<std::vector<Box>> boxes_of_change(const SceneSurfaces& other) const;

 private:
  using Surface = std::pair<uint64_t, Box>;  // hash of what it looks like, and its bounds
  void add_meshes(const Scene& scene, std::span<const uint64_t> materials);
  void add_shapes(const Scene& scene, std::span<const uint64_t> materials);

  Vec3d origin_;
  size_t textures_ = 0;
  std::vector<Surface> surfaces_;  // sorted
};

// Returns at most `most` boxes that together hold all given ones. Neighbours are merged first.
std::vector<Box> few_boxes(std::span<const Box> boxes, size_t most);

// True if walks end at the first surface that they meet, whatever it is: all surfaces are matte.
bool ends_all_walks(const Scene& scene);

class RayRegions {
 public:
  // Adds a region, whose number is the former size().
  void add(std::span<const Box> boxes);
  size_t size() const { return regions_; }
  // Returns the same regions with all boxes wider by `margin` on every side.
  RayRegions widened(float margin) const;
  // Appends the numbers of all regions that the ray meets to `out`, in order and once each.
  void find(const Ray& ray, std::vector<uint32_t>& out) const;
  // True if a point lies in a region, or at most `margin` metres off in each direction.
  bool holds(size_t region, const Vec3& point, float margin) const;

 private:
  size_t regions_ = 0;
  std::array<std::vector<float>, 6> sides_;  // lower x, y, z, then upper ones, per box
  std::vector<uint32_t> region_of_;          // per box, in order
};

}  // namespace troffer
