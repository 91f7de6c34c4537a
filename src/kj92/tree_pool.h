// Bintrees that one thread keeps from viewing ray to viewing ray, so that the pattern found at one
// point is there for the next on the same object [1, §4].
// References: [1] Kok & Jansen, Eurographics '92.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "kj92/bintree.h"

namespace troffer {

// For whom a pattern is: a pattern is reused where all of this is the same.
struct TreeKey {
  uint32_t source = 0;
  uint32_t geometry = 0;  // the object, as in Hit
  uint32_t depth = 0;     // viewing rays are 0, those that they spawn 1, …
  bool is_front = true;
  bool operator==(const TreeKey&) const = default;
};

class TreePool {
 public:
  struct Entry {
    explicit Entry(const BintreeOptions& options) : tree(options) {}
    Bintree tree;
    TreeKey key;
    Vec3 normal;               // of the surface where the pattern was found
    bool has_pattern = false;  // the tree holds one that may be reused
    uint64_t last_used = 0;
  };

  explicit TreePool(const BintreeOptions& options) : options_(options) {}

  // Forgets all patterns: what follows does not depend on what was before.
  void forget();

  // The tree of `key`, with its pattern if `reuses` and the surface faces about the same way; else
  // without. Entries in use (by `acquire` since the last `release_all`) are never given away; of
  // the others the one that was not used for longest makes room.
  Entry& acquire(const TreeKey& key, const Vec3& normal, bool reuses);
  void release_all() { first_free_tick_ = ++tick_; }

 private:
  static constexpr size_t most_idle = 96;

  BintreeOptions options_;
  std::vector<std::unique_ptr<Entry>> entries_;
  uint64_t tick_ = 0, first_free_tick_ = 0;
};

}  // namespace troffer
