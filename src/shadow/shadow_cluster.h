// A cluster of receivers, as all stages of certified visibility share it: what they are, the body
// that holds them, and what they get of a source that nothing hides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "shadow/shadow_source.h"
#include "shadow/shaft.h"
#include "shadow/unoccluded.h"

namespace troffer {

struct ShadowReceiver {
  Vec3 position;
  Vec3 horizon;     // unit geometric normal: what lies behind it sends no light
  Vec3 normal;      // unit; of the cosine
  Vec3 origin;      // where rays start: position, moved off its surface along the horizon's normal
  uint64_t stream;  // hash of pixel and sample
  // The name of the sequence that the samples of a pixel share, and which of them this is; 0: none.
  uint64_t pixel = 0;
  uint32_t sample = 0;
  float floor = 0;  // brightness × sr: where less light arrives errors are compared with this
};

struct ShadowCluster {
  std::span<const ShadowReceiver> receivers;  // at least one; they belong to the caller
  ReceiverArrays arrays;                      // positions and normals, coordinate by coordinate
  ReceiverHull hull;                          // of all of them
  bool has_own_horizons = false;              // somebody's horizon is not that of the normal

  // Becomes the cluster of these, and keeps its memory.
  void set(std::span<const ShadowReceiver> of);
  size_t size() const { return receivers.size(); }
};

// The body that holds the origins of some receivers, at least one.
ReceiverHull hull_of(const ShadowCluster& cluster, std::span<const uint32_t> members);

// Reorders members so that those before the number returned lie on one side of the median along
// the longest axis. The two sets do not depend on the order that they had.
size_t halve_members(const ShadowCluster& cluster, std::span<uint32_t> members);

// values[i]: projected solid angle of a source from receiver i, nothing hidden, sr. `outline`: the
// part of the source that counts, a polygon. Round sources do not know horizons other than that of
// the normal, nor do polygons that are parts of a disk.
void unoccluded_light(const ShadowCluster& cluster, const FlatSource& source,
                      std::span<const Vec3d> outline, std::vector<float>& values);
void unoccluded_light(const ShadowCluster& cluster, const FlatSource& source,
                      std::vector<float>& values);
void unoccluded_light(const ShadowCluster& cluster, const SphereSource& source,
                      std::vector<float>& values);

}  // namespace troffer
