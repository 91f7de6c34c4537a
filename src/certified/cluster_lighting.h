// Direct light at one cluster of hits: by certificates, masks and rays, or by sampled lights where
// those cost less. CertifiedLights makes one object per batch and calls add() for each cluster.
#pragma once

#include <cstdint>
#include <span>

#include "certified/certified_lights.h"

namespace troffer {

// Returns the input of environment sampling for these hits.
EnvironmentSamplerInputs environment_inputs(const PreparedScene& scene,
                                            const CertifiedSources& sources,
                                            const WaitingHits& hits);

class ClusterLighting {
 public:
  // All arguments must outlive this object. The scratch holds the hits of the batch.
  ClusterLighting(const PreparedScene& scene, const CertifiedSources& sources,
                  const DrawingBudget& budget, CertifiedLightsScratch& scratch, RadianceBatch& out,
                  Counters& counters)
      : scene_(scene),
        sources_(sources),
        environment_(sources.environment()),
        budget_(budget),
        s_(scratch),
        out_(out),
        counters_(counters) {}

  // Adds the light of all sources at the cluster's hits.
  void add(std::span<const uint32_t> members);

 private:
  void count_closed_off(std::span<const uint32_t> members);
  bool may_be_proved_far(std::span<const uint32_t> members);
  bool is_proof_of_far_worth(std::span<const uint32_t> members);
  void set_requests(bool has_far);
  void draw(std::span<const uint32_t> members);
  std::span<const float> certify(std::span<const uint32_t> members, bool has_far);
  void set_draws(std::span<const uint32_t> members, uint32_t effort_divisor);
  void certify_or_draw(std::span<const uint32_t> members);
  void add_answers(uint32_t request, std::span<const uint32_t> members,
                   std::span<const SourceVisibility> answers);

  const PreparedScene& scene_;
  const CertifiedSources& sources_;
  const CertifiedEnvironment& environment_;
  const DrawingBudget& budget_;
  CertifiedLightsScratch& s_;
  RadianceBatch& out_;
  Counters& counters_;
};

}  // namespace troffer
