// Rays -> hits, in batches. The only user of Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "trace/ray.h"

namespace troffer {

// Coherent rays (such as a pixel's viewing rays) are traced in packets.
enum class Coherence { none, coherent };

// All rays that a tracer is asked about, in order: for benchmarks.
struct RayLog {
  struct Batch {
    size_t first, size;  // in `rays`
    Coherence coherence;
    bool is_occlusion;
  };
  std::vector<Ray> rays;
  std::vector<Batch> batches;
};

// The acceleration structure of a scene, which must outlive it. Immutable and safe to use from
// many threads; results do not depend on how many. Rays that are not finite or reach beyond 1e18
// hit nothing and count as occluded.
class Tracer {
 public:
  // Throws EnvironmentError if memory runs out.
  explicit Tracer(const Scene& scene);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // hits[i] = closest hit of rays[i]. Hits that an alpha mask makes transparent do not count.
  void closest(std::span<const Ray> rays, std::span<Hit> hits,
               Coherence coherence = Coherence::none) const;
  // is_occluded[i] = 1 if anything lies on rays[i], else 0.
  void occluded(std::span<const Ray> rays, std::span<uint8_t> is_occluded,
                Coherence coherence = Coherence::none) const;

  // The same, coherent, for segments.
  void occluded(const Segments& segments, std::span<uint8_t> is_occluded) const;

  // From now on also writes all rays into `log` (null: no more). Not while other threads trace.
  void set_log(RayLog* log) { log_ = log; }

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  RayLog* log_ = nullptr;
};

}  // namespace troffer
