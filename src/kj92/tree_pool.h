// Pool of bintrees that one thread keeps from viewing ray to viewing ray. The pattern found at one
// point is reused at the next point on the same object [1, §4].
// References: [1] Kok & Jansen, Eurographics '92.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "kj92/bintree.h"

namespace troffer {

// Key of a pattern. A pattern is reused only where all fields agree.
struct TreeKey {
  uint32_t source = 0;
  uint32_t geometry = 0;  // the object, as in Hit
  uint32_t depth = 0;     // 0 for viewing rays, 1 for rays that they spawn, and so on
  bool is_front = true;
  bool operator==(const TreeKey&) const = default;
};

// Bintrees by key. One per thread.
class TreePool {
 public:
  struct Entry {
    explicit Entry(const BintreeOptions& options) : tree(options) {}
    Bintree tree;
    TreeKey key;
    Vec3 normal;               // normal of the surface where the pattern was found
    bool has_pattern = false;  // the tree holds a reusable pattern
    uint64_t last_used = 0;
  };

  explicit TreePool(const BintreeOptions& options) : options_(options) {}

  // Forgets all patterns, so that later results do not depend on earlier ones.
  void forget();

  // Returns the tree of `key`. It has its pattern only if `reuses` and if the surface faces about
  // the same way. Entries acquired since the last `release_all` are in use and stay untouched. Of
  // the others, the least recently used one is recycled.
  Entry& acquire(const TreeKey& key, const Vec3& normal, bool reuses);
  void release_all() { first_free_tick_ = ++tick_; }

 private:
  static constexpr size_t most_idle = 96;

  BintreeOptions options_;
  std::vector<std::unique_ptr<Entry>> entries_;
  uint64_t tick_ = 0, first_free_tick_ = 0;
};

}  // namespace troffer
