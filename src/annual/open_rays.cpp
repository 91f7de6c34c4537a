#include "annual/open_rays.h"

namespace troffer {

const Ray& OpenRays::add(const CellHit& from, const Vec3& direction) {
  Ray& r = rays_.emplace_back();
  r.origin = from.position + from.horizon * from.offset;
  r.direction = direction;
  return r;
}

void OpenRays::trace() {
  is_occluded_.assign(rays_.size(), 0);
  factors_.values.clear();
  if (!rays_.empty()) tracer_.occluded(rays_, is_occluded_, Coherence::coherent, factors_);
}

}  // namespace troffer
