#include "certified/light_shares.h"

#include <numeric>

namespace troffer {

// Adds the unoccluded light of a source to group k at all receivers, luminance × sr.
void LightShares::add_source(const CertifiedSource& source, size_t k) {
  if (source.is_round)
    unoccluded_light(cluster_, source.sphere, values_);
  else
    unoccluded_light(cluster_, source.flat, values_);
  const float strength = luminance(source.radiance);
  for (size_t i = 0; i < receivers_.size(); ++i) sums_[i * n_ + k] += values_[i] * strength;
}

void LightShares::set(const LightGroups& groups, std::span<const CertifiedSource> sources,
                      const WaitingHits& hits, std::span<const uint32_t> members,
                      std::span<const uint32_t> chosen, std::span<const float> estimates) {
  // Share of the estimate that is added to the closed form, which may round to zero.
  constexpr float share_of_estimate = 0.01f;
  // Limit for closed forms. A curved lamp has thousands of groups, too many to evaluate at each
  // hit.
  constexpr size_t most_groups = 64;
  n_ = chosen.size();
  is_shared_ = groups.are_many() || n_ > most_groups;
  sums_.assign(is_shared_ ? n_ : n_ * members.size(), 0);
  receivers_.clear();
  if (!is_shared_) {
    for (const uint32_t m : members) receivers_.push_back(hits.receivers[m]);
    cluster_.set(receivers_);
  }
  for (size_t k = 0; k < n_; ++k) {
    const LightGroup& g = groups[chosen[k]];
    const bool has_closed_form = !is_shared_ && g.first_source < g.last_source;
    const float estimate = has_closed_form ? share_of_estimate * estimates[k] : estimates[k];
    for (size_t at = k; at < sums_.size(); at += n_) sums_[at] = estimate;
    if (!has_closed_form) continue;
    for (uint32_t i = g.first_source; i < g.last_source; ++i) add_source(sources[i], k);
  }
  for (size_t first = 0; first < sums_.size(); first += n_)
    std::partial_sum(&sums_[first], &sums_[first] + n_, &sums_[first]);
}

}  // namespace troffer
