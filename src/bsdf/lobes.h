// What the lobes of a Bsdf have in common for all directions of incidence, seen from one direction.
#pragma once

#include "bsdf/bsdf.h"

namespace troffer {

struct LobeConstants {
  // Probabilities with which sample() takes the glossy lobe, and directions by a cosine or evenly
  // on the viewer's side.
  float glossy = 0, cosine = 0, uniform = 0;
  // What the coat lets through of the diffuse lobe, and of the soft lobe.
  float diffuse_gain = 1, soft_gain = 0;
};

// cos_o > 0: of the direction seen from. For Bsdfs that do not transmit.
LobeConstants lobe_constants(const Bsdf& bsdf, float cos_o);

}  // namespace troffer
