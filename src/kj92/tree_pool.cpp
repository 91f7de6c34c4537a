#include "kj92/tree_pool.h"

namespace troffer {

namespace {

// Cosine of 25 degrees, within which surfaces count as facing the same way.
constexpr float cos_same_way = 0.906f;

}  // namespace

void TreePool::forget() {
  // The number of entries decides when patterns are evicted, so it must not depend on the past
  // either.
  if (entries_.size() > most_idle) entries_.resize(most_idle);
  for (const auto& e : entries_) {
    e->has_pattern = false;
    e->last_used = 0;
  }
  tick_ = 1;
  first_free_tick_ = 1;
}

TreePool::Entry& TreePool::acquire(const TreeKey& key, const Vec3& normal, bool reuses) {
  Entry* oldest = nullptr;
  Entry* found = nullptr;
  for (const auto& e : entries_) {
    if (e->last_used >= first_free_tick_) continue;  // in use
    if (e->has_pattern && e->key == key) {
      found = e.get();
      break;
    }
    if (oldest == nullptr || e->last_used < oldest->last_used) oldest = e.get();
  }
  if (found == nullptr) {
    // Keeps patterns and allocates new entries until there are many.
    if (oldest == nullptr || (oldest->has_pattern && entries_.size() < most_idle)) {
      entries_.push_back(std::make_unique<Entry>(options_));
      oldest = entries_.back().get();
    }
    found = oldest;
    found->has_pattern = false;
  }
  if (!reuses || dot(found->normal, normal) < cos_same_way) found->has_pattern = false;
  found->key = key;
  found->normal = normal;
  found->last_used = ++tick_;
  return *found;
}

}  // namespace troffer
