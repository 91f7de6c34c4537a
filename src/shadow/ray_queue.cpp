#include "shadow/ray_queue.h"

namespace troffer {

void RayQueue::clear() {
  sources.clear();
  frames.clear();
  open.clear();
  by_points.clear();
  points.clear();
  values.clear();
}

void RayQueue::add(uint32_t member, const Vec3& origin, const OpenSamples& samples, float light,
                   float unoccluded, uint64_t random, uint32_t passes) {
  open.push_back({member, uint32_t(sources.size() - 1), uint32_t(frames.size() - 1), origin, light,
                  unoccluded, random, passes, samples});
}

void RayQueue::add(uint32_t member, const Vec3& origin, std::span<const Vec3> at,
                   std::span<const Rgb> values_there, float light, bool is_difference) {
  by_points.push_back({member, uint32_t(sources.size() - 1), uint32_t(points.size()),
                       uint32_t(at.size()), origin, light, is_difference});
  points.insert(points.end(), at.begin(), at.end());
  values.insert(values.end(), values_there.begin(), values_there.end());
}

}  // namespace troffer
