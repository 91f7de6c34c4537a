#include "transport/matte_rays.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "trace/surface.h"

namespace troffer {

namespace {

// Computes weights and rays to all points and returns the smallest weight. A ray ends before the
// light, by twice the offset of a ray that starts there, so that the light does not occlude itself
// (ended_before_light()).
TROFFER_MULTIVERSION
float aim(const MatteReceiver& receiver, size_t n, const float* __restrict x,
          const float* __restrict y, const float* __restrict z, const float* __restrict nx,
          const float* __restrict ny, const float* __restrict nz,
          const float* __restrict inverse_pdf, float* __restrict weight, float* __restrict ox,
          float* __restrict oy, float* __restrict oz, float* __restrict dx, float* __restrict dy,
          float* __restrict dz) {
  const MatteReceiver r = receiver;
  const Vec3 shift = r.position - r.origin;
  const float here =
      std::max({std::abs(r.position.x), std::abs(r.position.y), std::abs(r.position.z)});
  float least = 1;
  for (size_t i = 0; i < n; ++i) {
    const Vec3 d{x[i], y[i], z[i]};
    const float shading = dot(d, r.shading_normal), geometric = dot(d, r.geometric_normal);
    const float d2 = std::max(dot(d, d), 1e-30f);
    const float w = std::max(shading, 0.0f) * inverse_pdf[i] / std::sqrt(d2);
    weight[i] = geometric > 0 ? w : 0.0f;
    least = std::min(least, weight[i]);
    const float magnitude =
        std::max(std::max(std::abs(r.position.x + d.x), std::abs(r.position.y + d.y)),
                 std::max(std::abs(r.position.z + d.z), here));
    const Vec3 way =
        ended_before_light(d + shift, {nx[i], ny[i], nz[i]}, 2 * ray_offset(magnitude));
    ox[i] = r.origin.x;
    oy[i] = r.origin.y;
    oz[i] = r.origin.z;
    dx[i] = way.x;
    dy[i] = way.y;
    dz[i] = way.z;
  }
  return least;
}

}  // namespace

void MatteRays::add(const MatteReceiver& from, const LightPoints& p, Group group) {
  const size_t n = p.size(), first = segments_.size();
  segments_.make_room(n);
  weights_.resize(std::max(weights_.size(), first + n));
  float* w = weights_.data() + first;
  const float least = aim(from, n, p.x.data(), p.y.data(), p.z.data(), p.nx.data(), p.ny.data(),
                          p.nz.data(), p.inverse_pdf.data(), w, segments_.end(0), segments_.end(1),
                          segments_.end(2), segments_.end(3), segments_.end(4), segments_.end(5));
  size_t kept = n;
  if (!(least > 0)) {  // Drop points of zero weight.
    kept = 0;
    for (size_t i = 0; i < n; ++i) {
      if (!(w[i] > 0)) continue;
      for (size_t c = 0; c < Segments::coordinates; ++c)
        segments_.end(c)[kept] = segments_.end(c)[i];
      w[kept++] = w[i];
    }
  }
  if (kept == 0) return;
  segments_.grow(kept);
  group.end = segments_.size();
  groups_.push_back(group);
}

// Adds the light of a group and its variance. The variance is that of a mean of independent points,
// an upper bound for stratified ones.
void MatteRays::tell(const Group& g, size_t first, RadianceBatch& out) const {
  float sum = 0, squares = 0;
  Rgb passed;  // light after panes
  for (size_t i = first; i < g.end; ++i) {
    float w = is_hidden_[i] != 0 ? 0.0f : weights_[i];
    if (!factors_.values.empty()) {
      passed += factors_[i] * w;
      w *= luminance(factors_[i]);
    }
    sum += w;
    squares += w * w;
  }
  const auto n = float(g.points);
  const Rgb arrived = factors_.values.empty() ? Rgb{sum} : passed;
  (g.is_direct ? out.direct : out.indirect)[g.index] += g.carried * (arrived / n);
  out.shadow_rays[g.index] += uint32_t(g.end - first);
  if (!g.is_direct || out.direct_variance.empty()) return;
  const float spread = std::max(squares - sum * sum / n, 0.0f);
  out.direct_variance[g.index] +=
      sqr(luminance(g.carried) / n) * (n > 1 ? spread * n / (n - 1) : squares);
}

void MatteRays::resolve(const Tracer& tracer, RadianceBatch& out, Counters& counters) {
  is_hidden_.resize(std::max(is_hidden_.size(), segments_.size()));
  tracer.occluded(segments_, is_hidden_, factors_);
  size_t first = 0;
  for (const Group& g : groups_) {
    tell(g, first, out);
    first = g.end;
  }
  counters.shadow_rays += segments_.size();
  segments_.clear();
  groups_.clear();
}

}  // namespace troffer
