// Properties of a Bsdf's lobes that depend on the viewing direction only. evaluate_many() computes
// them once and then evaluates many directions. Probabilities and factors are in [0,1].
#pragma once

#include "bsdf/bsdf.h"

namespace troffer {

struct LobeConstants {
  // Probabilities with which sample() chooses the glossy lobe, and cosine-weighted or uniform
  // directions on the viewer's side.
  float glossy = 0, cosine = 0, uniform = 0;
  // Factors g of the diffuse lobe and of the soft lobe at wo.
  float diffuse_gain = 1, soft_gain = 0;
};

// Precondition: cos_o > 0, and the Bsdf does not transmit.
LobeConstants lobe_constants(const Bsdf& bsdf, float cos_o);

}  // namespace troffer
