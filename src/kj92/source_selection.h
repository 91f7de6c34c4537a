// Source selection: decides for every patch which sources deserve shadow rays. The light of all
// other sources is its general radiosity. BintreeDirect and RadiosityIndirect use it.
// At each sample point, the general radiosity and the contributions of treated sources add up to
// the irradiance of the solution: nothing is lost or counted twice. The solution stores only the
// strongest contributions of a point. Those of other treated sources are computed again
// (source_contributions) and subtracted from the general radiosity.
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

// Settings of the selection.
struct SelectionOptions {
  // If false, every light is sampled on every patch, and bright patches are not selected.
  bool is_enabled = true;
  SelectionThresholds thresholds;
  // Allows the selection of bright patches.
  bool uses_patches = true;
  // If true, only the lights in `only` and lights without a surface are treated. Other lights and
  // all patches stay in the general radiosity.
  bool is_restricted = false;
  std::vector<uint32_t> only;
};

// A source that is probed or sampled on a patch. `source` is numbered as in StoredContribution:
// lights of the scene first, then patches.
struct TreatedSource {
  uint32_t source = no_source;
  SourceClass source_class;
};

// Irradiance that is not sampled, W/m² or lx: direct light from lights, and all other light.
struct GeneralIrradiance {
  Rgb direct, indirect;
};

// Result of the selection for a whole scene; immutable and thread safe.
class SourceSelection {
 public:
  // All arguments belong to one scene and are used only by the constructor. The result does not
  // depend on `threads`. It is unusable if `stop` was set.
  SourceSelection(const RadiositySolution& solution, const Tracer& tracer,
                  const LightPrimitives& primitives, const SelectionOptions& options, int threads,
                  const StopFlag& stop);

  // Returns the treated sources of a patch in increasing order of source.
  std::span<const TreatedSource> of_patch(uint32_t patch) const {
    return {sources_.data() + first_[patch], first_[patch + 1] - first_[patch]};
  }

  // Returns the general radiosity at a place on the front or back of a fragment, which must have a
  // sample point. weights: of the fragment's corners (fragment_at). Includes the ambient estimate
  // of unshot light.
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
  std::vector<size_t> first_;             // per patch: start in sources_; one more at the end
  std::vector<GeneralIrradiance> knots_;  // by fragment, side and knot (interpolation.h)
};

}  // namespace troffer
