// Rays -> hits, in batches. The only user of Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "trace/panes.h"
#include "trace/ray.h"

namespace troffer {

// Coherent rays (such as a pixel's viewing rays) are traced in packets.
enum class Coherence { none, coherent };

// Which surfaces rays meet.
enum class Meeting : uint8_t {
  all,
  no_panes,
  as_seen,  // as the eye does: not the backs of those that are unseen from there
};

// The same scene, its vertices such that a tracer needs no copies of them; not to be changed then.
Scene with_room_for_tracer(Scene scene);

// The acceleration structure of a scene, which must outlive it. Immutable and safe to use from
// many threads; results do not depend on how many. Rays that are not finite or reach beyond 1e18
// hit nothing and count as occluded.
//
// Panes are hit by rays as all else is, but hide nothing. `factors` is set to what they leave of
// the light of rays that are not occluded.
class Tracer {
 public:
  // Throws EnvironmentError if memory runs out.
  explicit Tracer(const Scene& scene) : Tracer(scene, nullptr) {}
  // glass: null: there are no panes; else it must outlive the tracer.
  Tracer(const Scene& scene, const PaneGlass* glass);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // hits[i] = closest hit of rays[i]. Hits that an alpha mask makes transparent do not count.
  void closest(std::span<const Ray> rays, std::span<Hit> hits,
               Coherence coherence = Coherence::none, Meeting meeting = Meeting::all) const;
  // is_occluded[i] = 1 if anything but a pane lies on rays[i], else 0.
  void occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded, Coherence coherence,
                PaneFactors& factors) const;
  // The same, coherent, for segments.
  void occluded(const Segments& segments, std::span<uint8_t> is_occluded,
                PaneFactors& factors) const;
  // Without asking what panes leave.
  void occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded,
                Coherence coherence = Coherence::none) const;
  void occluded(const Segments& segments, std::span<uint8_t> is_occluded) const;

  bool has_panes() const { return glass_ != nullptr; }
  // What panes on a ray leave of its light, whatever else is on it.
  Rgb transmittance(const Ray& ray) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  const PaneGlass* glass_ = nullptr;  // null: there are no panes
};

}  // namespace troffer
