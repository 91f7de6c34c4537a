// Source selection: for every patch the sources that deserve shadow rays, and the general radiosity
// value that all others leave.
//
// Nothing is lost and nothing counted twice: at each sample point the general value and what the
// preprocessing found of the treated sources add up to the irradiance that it found, whichever
// patch asks. A source that is treated on a patch but was not kept separately at one of the points
// there is looked up again (source_contributions) and taken out of the point's general value.
// References: as in source_class.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/rgb.h"
#include "kj92/source_class.h"
#include "light/light_primitive.h"
#include "radiosity/interpolation.h"
#include "radiosity/solution.h"
#include "trace/tracer.h"

namespace troffer {

struct SelectionOptions {
  // false: every light is sampled on every patch, bright patches nowhere.
  bool is_enabled = true;
  SelectionThresholds thresholds;
  // Bright patches may be selected like lights.
  bool uses_patches = true;
  // Only these lights, and no patches, may be treated; all others stay in the general value.
  bool is_restricted = false;
  std::vector<uint32_t> only;
};

// A source that is treated on a patch: SourceTreatment::probed or sampled. Lights of the scene,
// then patches, as in StoredContribution.
struct TreatedSource {
  uint32_t source = no_source;
  SourceClass source_class;
};

// Irradiance that is not sampled, W/m² or lx: what comes straight from lights, and all else.
struct GeneralIrradiance {
  Rgb direct, indirect;
};

class SourceSelection {
 public:
  // All arguments belong to one scene and are used here only. Does not depend on `threads`. Of no
  // use once `stop` is set.
  SourceSelection(const RadiositySolution& solution, const Tracer& tracer,
                  const LightPrimitives& primitives, const SelectionOptions& options, int threads,
                  const StopFlag& stop);

  // In increasing order of source.
  std::span<const TreatedSource> of_patch(uint32_t patch) const {
    return {sources_.data() + first_[patch], first_[patch + 1] - first_[patch]};
  }

  // The general value at a place of a fragment's front or back, which must have a sample point.
  // weights: of the fragment's corners (fragment_at). With the ambient estimate for light that is
  // still unshot.
  GeneralIrradiance general(uint32_t fragment, bool is_back, const Vec3& weights) const {
    const GeneralIrradiance* const at_knots =
        knots_.data() + knots_per_fragment * (2 * size_t(fragment) + (is_back ? 1 : 0));
    const auto weight = knot_weights(weights);
    GeneralIrradiance sum;
    for (size_t k = 0; k < knots_per_fragment; ++k) {
      sum.direct += at_knots[k].direct * weight[k];
      sum.indirect += at_knots[k].indirect * weight[k];
    }
    return sum;
  }

  size_t memory_bytes() const;

 private:
  std::vector<TreatedSource> sources_;
  std::vector<size_t> first_;             // per patch, into sources_; one more at the end
  std::vector<GeneralIrradiance> knots_;  // fragment × side × knot (interpolation.h)
};

}  // namespace troffer
