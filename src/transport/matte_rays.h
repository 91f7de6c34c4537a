// Batches of shadow rays from matte surfaces. Each ray stores a single weight. The factor that is
// common to a group of rays, from one vertex to one source, is stored once. Used by SourceSampler.
#pragma once

#include <cstdint>
#include <vector>

#include "light/light_points.h"
#include "trace/tracer.h"
#include "transport/batch.h"

namespace troffer {

// A matte surface point; all rays start on the viewer's side of it.
struct MatteReceiver {
  Vec3 position;
  Vec3 geometric_normal, shading_normal;  // on the viewer's side
  Vec3 origin;                            // origin of rays, offset from the surface
};

class MatteRays {
 public:
  // Rays from one vertex to one source. `index` is the viewing ray and `carried` the radiance per
  // projected solid angle. `points` is the sample count, including points of zero weight that have
  // no ray.
  struct Group {
    uint32_t index = 0, points = 0;
    Rgb carried;
    bool is_direct = true;
    size_t end = 0;
  };

  size_t size() const { return segments_.size(); }
  // Adds rays to all points from which light can arrive.
  void add(const MatteReceiver& from, const LightPoints& points, Group group);
  // Traces all rays, adds the light that arrives to `out`, and empties the batch.
  void resolve(const Tracer& tracer, RadianceBatch& out, Counters& counters);

 private:
  void tell(const Group& g, size_t first, RadianceBatch& out) const;

  Segments segments_;
  std::vector<float> weights_;
  std::vector<Group> groups_;
  std::vector<uint8_t> is_hidden_;
  PaneFactors factors_;
};

}  // namespace troffer
