#include "kj92/bintree.h"

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

// Returns the level at which an even tree has at least `rays` leaves, but at most `most_rays`.
int level_of(int rays, int most_rays) {
  int level = std::bit_width(uint32_t(std::max(rays, 1)) - 1);
  while (level > 0 && (level > BintreeNodes::max_level || (1 << level) > most_rays)) --level;
  return level;
}

BintreeOptions checked(BintreeOptions o) {
  o.most_rays = std::clamp(o.most_rays, 1, 1 << 20);
  o.initial_rays = std::clamp(o.initial_rays, 1, o.most_rays);
  o.level_difference = std::max(o.level_difference, 0);
  o.mean_change_iterations = std::clamp(o.mean_change_iterations, 1, 16);
  return o;
}

}  // namespace

Bintree::Bintree(const BintreeOptions& options)
    : options_(checked(options)), nodes_(size_t(options_.most_rays)) {
  const size_t rays = size_t(options_.most_rays);
  pending_.reserve(rays);
  pending_uv_.reserve(rays);
  scratch_.reserve(4 * rays);
}

void Bintree::begin(float unoccluded) {
  set_unoccluded(unoccluded);
  means_.iterations = 0;
  estimate_ = {};
  ask();
}

void Bintree::start(uint64_t stream, float unoccluded, int initial_rays) {
  random_ = Random(stream);
  initial_level_ =
      level_of(initial_rays > 0 ? initial_rays : options_.initial_rays, options_.most_rays);
  plant(nodes_, initial_level_, random_, pending_);
  leaves_ = pending_.size();
  begin(unoccluded);
}

void Bintree::resample(uint64_t stream, float unoccluded) {
  random_ = Random(stream);
  pending_.clear();
  nodes_.for_each_leaf([&](int32_t leaf) { pending_.push_back(leaf); });
  if (options_.renews_jitter) {
    for (const int32_t leaf : pending_) nodes_.jitter(leaf, random_);
  }
  begin(unoccluded);
}

void Bintree::ask() {
  pending_uv_.clear();
  for (const int32_t leaf : pending_) pending_uv_.push_back(nodes_[leaf].uv);
}

void Bintree::supply(std::span<const ShadowRayResult> results) {
  TROFFER_CHECK(results.size() == pending_.size());
  for (size_t i = 0; i < results.size(); ++i) {
    nodes_.set_result(pending_[i], results[i].is_visible, results[i].kernel);
  }
  if (means_.iterations == 0) {
    nodes_.propagate_all();
  } else {
    for (const int32_t leaf : pending_) nodes_.propagate_up(leaf);
  }
  estimate_.rays += uint32_t(results.size());
  estimate_.mean = nodes_[BintreeNodes::root].mean;
  estimate_.variance = nodes_[BintreeNodes::root].variance;
  means_.ring[means_.iterations++ % means_.ring.size()] = estimate_.mean;
  pending_.clear();
  estimate_.stop = stop_reason();
  if (estimate_.stop == BintreeStop::none) refine();
  ask();
}

// [rule 2] The comparison is strict, so an allowed error of 0 is never met.
bool Bintree::is_variance_met() const {
  return estimate_.variance <
         sqr(options_.allowed_variance * allowed_.leniency * allowed_.unoccluded);
}

// [rule 5] True if the mean has hardly changed over the last iterations.
bool Bintree::is_mean_settled() const {
  const size_t wanted = size_t(options_.mean_change_iterations);
  if (options_.mean_change <= 0 || options_.allowed_variance <= 0) return false;
  if (means_.iterations < wanted || estimate_.rays < uint32_t(std::max(options_.enough_rays, 0))) {
    return false;
  }
  float low = estimate_.mean, high = low;
  for (size_t i = 1; i <= wanted; ++i) {
    const float m = means_.ring[(means_.iterations - i) % means_.ring.size()];
    low = std::min(low, m);
    high = std::max(high, m);
  }
  return high - low <= options_.mean_change * allowed_.leniency * allowed_.unoccluded;
}

bool Bintree::is_cap_reached() const {
  return leaves_ >= size_t(options_.most_rays);
}

BintreeStop Bintree::stop_reason() const {
  if (is_variance_met()) return BintreeStop::variance;
  if (is_mean_settled()) return BintreeStop::mean;
  return is_cap_reached() ? BintreeStop::cap : BintreeStop::none;
}

void Bintree::refine() {
  const bool is_even = options_.allowed_variance <= 0;
  const int32_t leaf = is_even ? choose_leaf_evenly(nodes_) : choose_leaf(nodes_);
  if (nodes_[leaf].level == BintreeNodes::max_level) {
    estimate_.stop = BintreeStop::finest;
    return;
  }
  split_pending(nodes_, leaf, random_, pending_);
  ++leaves_;
  if (is_even) return;
  enforce_level_difference(nodes_, leaf, options_.level_difference, size_t(options_.most_rays),
                           leaves_, random_, pending_, scratch_);
}

void Bintree::shrink() {
  if (options_.allowed_variance <= 0) return;  // the even tree would only be split again
  troffer::shrink(nodes_, initial_level_, options_.level_difference, random_, scratch_);
  leaves_ = nodes_[BintreeNodes::root].samples;
}

float Bintree::mean_of_pending(std::span<const ShadowRayResult> results) const {
  double sum = 0, measure = 0;
  for (size_t i = 0; i < pending_.size(); ++i) {
    const double cell = double(nodes_.cell(pending_[i]).measure());
    sum += cell * double(results[i].kernel);
    measure += cell;
  }
  return measure > 0 ? float(sum / measure) : 0.0f;
}

float Bintree::kernel_mean() const {
  double sum = 0;
  nodes_.for_each_leaf([&](int32_t leaf) {
    sum += double(nodes_.cell(leaf).measure()) * double(nodes_[leaf].kernel);
  });
  return float(sum);
}

}  // namespace troffer
