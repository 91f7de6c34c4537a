// Traces batches of rays: closest hits, occlusion, and transmittance of panes. The only interface
// to Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "trace/panes.h"
#include "trace/ray.h"

namespace troffer {

// Coherent rays, such as the viewing rays of a pixel, are traced in packets.
enum class Coherence { none, coherent };

// Surfaces that rays can hit.
enum class Meeting : uint8_t {
  all,
  no_panes,
  as_seen,  // all except invisible back faces
};

// Returns the scene with spare capacity behind its vertices, so that a tracer needs no copies. The
// scene must not change afterwards.
Scene with_room_for_tracer(Scene scene);

// Acceleration structure of a scene, which must outlive it. Immutable and thread safe; results do
// not depend on the number of threads. Rays that are not finite or reach beyond 1e18 hit nothing
// and count as occluded.
//
// Panes are hit like other surfaces but do not occlude. `factors` is set to the transmittance of
// panes on rays that are not occluded.
class Tracer {
 public:
  // Throws EnvironmentError if memory runs out.
  explicit Tracer(const Scene& scene) : Tracer(scene, nullptr) {}
  // glass: null if there are no panes; otherwise it must outlive the tracer.
  Tracer(const Scene& scene, const PaneGlass* glass);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // Sets hits[i] to the closest hit of rays[i]. Ignores hits that an alpha mask makes transparent.
  void closest(std::span<const Ray> rays, std::span<Hit> hits,
               Coherence coherence = Coherence::none, Meeting meeting = Meeting::all) const;
  // Sets is_occluded[i] to 1 if anything except a pane lies on rays[i], else to 0.
  void occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded, Coherence coherence,
                PaneFactors& factors) const;
  // Does the same for segments, in packets.
  void occluded(const Segments& segments, std::span<uint8_t> is_occluded,
                PaneFactors& factors) const;
  // Does the same without transmittance.
  void occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded,
                Coherence coherence = Coherence::none) const;
  void occluded(const Segments& segments, std::span<uint8_t> is_occluded) const;

  bool has_panes() const { return glass_ != nullptr; }
  // Returns the transmittance of all panes on a ray, whatever else it hits.
  Rgb transmittance(const Ray& ray) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  const PaneGlass* glass_ = nullptr;  // null: no panes
};

}  // namespace troffer
