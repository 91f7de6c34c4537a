// Shadow rays from matte surfaces, gathered over many: a ray brings a number, and what the light of
// a group of them (those of one vertex to one source) is multiplied by stands beside them once.
#pragma once

#include <cstdint>
#include <vector>

#include "light/light_points.h"
#include "trace/tracer.h"
#include "transport/batch.h"

namespace troffer {

// A matte surface at which rays start, all on the viewer's side of it.
struct MatteReceiver {
  Vec3 position;
  Vec3 geometric_normal, shading_normal;  // on the viewer's side
  Vec3 origin;                            // of its rays, clear of the surface
};

class MatteRays {
 public:
  // What a group carries to the eye: index of the viewing ray, radiance per projected solid angle;
  // `points` for which its rays stand, of which others have no weight.
  struct Group {
    uint32_t index = 0, points = 0;
    Rgb carried;
    bool is_direct = true;
    size_t end = 0;
  };

  size_t size() const { return segments_.size(); }
  // Rays to all of the points from which light can arrive.
  void add(const MatteReceiver& from, const LightPoints& points, Group group);
  // Traces all, adds what arrives to `out`, and empties the store.
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
