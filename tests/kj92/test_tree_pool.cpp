// Tests TreePool: reuse by key, entries in use, and independence of the past.
#include "kj92/tree_pool.h"

#include <doctest/doctest.h>

#include <set>
#include <vector>

#include "base/random.h"

using namespace troffer;

namespace {

const Vec3 up{0, 0, 1};

TreeKey key(uint32_t source, uint32_t geometry = 0, uint32_t depth = 0, bool is_front = true) {
  return {source, geometry, depth, is_front};
}

// Acquires a tree as the sampler does. Returns true if it had a pattern, and leaves one in it.
bool use(TreePool& pool, const TreeKey& k, const Vec3& normal = up, bool reuses = true) {
  TreePool::Entry& e = pool.acquire(k, normal, reuses);
  const bool had = e.has_pattern;
  e.has_pattern = true;
  return had;
}

// Simulates vertices with random numbers of sources on random objects. Returns which trees had a
// pattern.
std::vector<bool> run_batch(TreePool& pool, uint64_t seed, uint32_t most_sources, int vertices) {
  Random random(seed);
  std::vector<bool> had;
  for (int v = 0; v < vertices; ++v) {
    pool.release_all();
    const uint32_t sources = 1 + random.next_u32() % most_sources;
    const uint32_t geometry = random.next_u32() % 7;
    for (uint32_t s = 0; s < sources; ++s) had.push_back(use(pool, key(s, geometry)));
  }
  return had;
}

}  // namespace

TEST_CASE("a pattern comes back to the same source, object, depth and side, and to no other") {
  TreePool pool{BintreeOptions{}};
  pool.forget();
  const auto next = [&](const TreeKey& k, const Vec3& n = up, bool reuses = true) {
    pool.release_all();
    return use(pool, k, n, reuses);
  };
  CHECK(!next(key(1)));
  CHECK(next(key(1)));
  CHECK(!next(key(2)));
  CHECK(!next(key(1, 5)));
  CHECK(!next(key(1, 0, 1)));
  CHECK(!next(key(1, 0, 0, false)));
  CHECK(next(key(1)));
  CHECK(next(key(1, 0, 0, false)));
  // On curved surfaces the pattern is reused after a small rotation, not after a large one.
  CHECK(next(key(1), normalize(Vec3{0.3f, 0, 1})));
  CHECK(!next(key(1), normalize(Vec3{-0.6f, 0, 1})));
  CHECK(!next(key(1), up, false));
  CHECK(next(key(1)));
}

TEST_CASE("trees in use are never given away") {
  TreePool pool{BintreeOptions{}};
  pool.forget();
  for (const uint32_t count : {3u, 40u, 95u, 96u, 97u, 300u, 5u, 120u}) {
    pool.release_all();
    std::set<const TreePool::Entry*> in_use;
    for (uint32_t s = 0; s < count; ++s) {
      TreePool::Entry& e = pool.acquire(key(s), up, true);
      CHECK(in_use.insert(&e).second);
      CHECK(e.key == key(s));
      e.has_pattern = true;
    }
  }
  // The same source twice at one vertex gets two trees.
  pool.release_all();
  TreePool::Entry& first = pool.acquire(key(0), up, true);
  CHECK(&first != &pool.acquire(key(0), up, true));
}

TEST_CASE("an address stays valid while others are acquired") {
  TreePool pool{BintreeOptions{}};
  pool.release_all();
  TreePool::Entry& first = pool.acquire(key(0), up, true);
  for (uint32_t s = 1; s < 500; ++s) pool.acquire(key(s), up, true);
  CHECK(first.key == key(0));
}

TEST_CASE("after forget() earlier use has no effect") {
  for (uint64_t seed = 0; seed < 30; ++seed) {
    // The thread's past: nothing, few vertices, or vertices of hundreds of sources.
    for (const uint32_t past : {0u, 20u, 130u, 400u}) {
      TreePool fresh{BintreeOptions{}}, used{BintreeOptions{}};
      fresh.forget();
      if (past > 0) run_batch(used, seed + 100, past, 5);
      used.forget();
      CAPTURE(seed);
      CAPTURE(past);
      for (const uint32_t sources : {3u, 30u, 60u})
        CHECK(run_batch(fresh, seed, sources, 40) == run_batch(used, seed, sources, 40));
    }
  }
}

TEST_CASE("the pool's memory stays within the trees in use, or a hundred") {
  TreePool pool{BintreeOptions{}};
  pool.forget();
  std::set<const TreePool::Entry*> all;
  for (uint32_t i = 0; i < 5000; ++i) {
    pool.release_all();
    all.insert(&pool.acquire(key(i), up, true));
    pool.acquire(key(i), up, true).has_pattern = true;
  }
  CHECK(all.size() <= 100);
}
