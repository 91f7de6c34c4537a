// Classifies one source for one patch: visible, occluded or partly occluded, and whether it gets
// shadow rays. Source selection uses it. At the sample points of a patch, B is the irradiance from
// the source in the radiosity solution, U the unoccluded irradiance, and r = B / U.
// References: [1] Kok & Jansen, "Source Selection for the Direct Lighting Computation in Global
//   Illumination", EG Workshop on Rendering 1991. [2] the same, "Adaptive Sampling of Area Light
//   Sources in Ray Tracing Including Diffuse Interreflection", Eurographics '92, §2 and §5. [2]
//   states the purpose of the criteria without formulas; the formulas here are ours.
#pragma once

#include <cstdint>
#include <span>

namespace troffer {

// View of a source from a patch.
enum class SourceView : uint8_t {
  occluded,  // r is about 0 at all points
  visible,   // r is about 1 at all points
  partly,    // anything else
};

// Treatment of a source at a patch.
enum class SourceTreatment : uint8_t {
  general,  // left in the general radiosity, without rays
  probed,   // visible or occluded, but important: a few probe rays check
  sampled,  // adaptive shadow rays: partly occluded and strong, or with a visible shadow edge
};

// Thresholds of the classification, chosen by us ([2] gives none).
struct SelectionThresholds {
  float occluded_below = 0.02f;  // occluded if r is at most this at all points
  float visible_above = 0.99f;   // visible if r is at least this at all points
  // Shares of a point's total irradiance, at the point of the patch where the share is largest.
  float major_share = 0.05f;   // sampled if not fully visible and B is at least this
  float shadow_edge = 0.02f;   // sampled if spread of r times U is at least this
  float probe_share = 0.02f;   // probed if visible and B, or occluded and U, is at least this
  float least_share = 0.002f;  // points that get less than this even unoccluded are ignored
};

// The source at one sample point, as luminances of irradiance.
struct SourceAtPoint {
  float received = 0;    // B
  float unoccluded = 0;  // U
  float total = 0;       // irradiance from all sources
};

// Result of the classification.
struct SourceClass {
  SourceView view = SourceView::occluded;
  SourceTreatment treatment = SourceTreatment::general;
  float least_visibility = 0, most_visibility = 0;  // range of r over the points that count
  float share = 0;                                  // largest B / total
};

// Classifies a source. points: the patch's sample points, and those across its border that
// interpolation on the patch uses, so that a shadow edge between the two is noticed. mean_total:
// mean irradiance over the points, which replaces `total` at darker points, because hardly any
// light there is important.
SourceClass classify(std::span<const SourceAtPoint> points, float mean_total,
                     const SelectionThresholds& thresholds);

}  // namespace troffer
