// The classification of one source as seen from one patch: does it deserve shadow rays?
//
// Over the patch's sample points, B is the irradiance that the preprocessing found to arrive from
// the source, U what would arrive if nothing were in the way, r = B / U.
// References: [1] Kok & Jansen, "Source Selection for the Direct Lighting Computation in Global
//   Illumination", EG Workshop on Rendering 1991. [2] the same, "Adaptive Sampling of Area Light
//   Sources in Ray Tracing Including Diffuse Interreflection", Eurographics '92, §2 and §5. [2]
//   says what the criteria are for and leaves out their formulas; those here are ours.
#pragma once

#include <cstdint>
#include <span>

namespace troffer {

// How much of a source a patch sees.
enum class SourceView : uint8_t {
  occluded,  // r is about 0 at all points
  visible,   // r is about 1 at all points
  partly,    // anything else
};

// What is done about it.
enum class SourceTreatment : uint8_t {
  general,  // left in the general radiosity value: no rays
  probed,   // occluded or visible as it seems, but important: a few rays look for surprises
  sampled,  // shadow rays, adaptively: it makes shadow boundaries, or is partly hidden and strong
};

struct SelectionThresholds {
  float occluded_below = 0.02f;  // r at all points: occluded
  float visible_above = 0.99f;   // r at all points: visible
  // Shares of a point's whole irradiance, at the point of the patch where the share is largest:
  float major_share = 0.05f;   // partly hidden and B above this: sampled
  float shadow_edge = 0.02f;   // … or spread of r times U above this: sampled even if weak
  float probe_share = 0.02f;   // visible and B above this, or occluded and U: probed
  float least_share = 0.002f;  // points that get less than this share even unoccluded say nothing
};

// One sample point's view of the source, as luminances.
struct SourceAtPoint {
  float received = 0;    // B
  float unoccluded = 0;  // U
  float total = 0;       // irradiance of the point, all sources together
};

struct SourceClass {
  SourceView view = SourceView::occluded;
  SourceTreatment treatment = SourceTreatment::general;
  float least_visibility = 0, most_visibility = 0;  // of r over the points that count
  float share = 0;                                  // largest B / total
};

// `points`: the patch's sample points, and those across its border that interpolation on it uses,
// so that a shadow's edge between the two is noticed. `mean_total`: mean irradiance over them,
// which stands in for `total` at darker points: where hardly any light comes, nothing of it is
// important.
SourceClass classify(std::span<const SourceAtPoint> points, float mean_total,
                     const SelectionThresholds& thresholds);

}  // namespace troffer
