#include "kj92/source_class.h"

#include <algorithm>

namespace troffer {

namespace {

SourceView view_of(float least, float most, const SelectionThresholds& t) {
  if (most <= t.occluded_below) return SourceView::occluded;
  return least >= t.visible_above ? SourceView::visible : SourceView::partly;
}

}  // namespace

SourceClass classify(std::span<const SourceAtPoint> points, float mean_total,
                     const SelectionThresholds& thresholds) {
  SourceClass c;
  float largest_unoccluded = 0;  // relative to the point's total
  float least = 1, most = 0;
  for (const SourceAtPoint& p : points) {
    // At dark points the mean total stands in, or every source would seem important.
    const float total = std::max(p.total, mean_total);
    const float whole = total > 0 ? total : p.unoccluded;
    if (!(p.unoccluded > thresholds.least_share * whole)) continue;
    const float r = std::clamp(p.received / p.unoccluded, 0.0f, 1.0f);
    least = std::min(least, r);
    most = std::max(most, r);
    c.share = std::max(c.share, p.received / whole);
    largest_unoccluded = std::max(largest_unoccluded, p.unoccluded / whole);
  }
  if (most < least) least = most;  // no point counts
  c.least_visibility = least;
  c.most_visibility = most;
  c.view = view_of(least, most, thresholds);
  const bool is_major = c.share >= thresholds.major_share;
  const bool has_edge = (most - least) * largest_unoccluded >= thresholds.shadow_edge;
  const float importance = c.view == SourceView::visible ? c.share : largest_unoccluded;
  // If a source is strong, even the little light that reaches an occluded patch can count.
  if (c.view != SourceView::visible && (is_major || has_edge)) {
    c.treatment = SourceTreatment::sampled;
  } else if (c.view != SourceView::partly && importance >= thresholds.probe_share) {
    c.treatment = SourceTreatment::probed;
  }
  return c;
}

}  // namespace troffer
