// Parallel loops, warnings and errors.
#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel.h"

using namespace troffer;

TEST_CASE("a parallel loop visits every index once, on any number of threads") {
  for (int threads = 0; threads <= 8; ++threads)
    for (const size_t n : {size_t(0), size_t(1), size_t(7), size_t(1000)}) {
      std::vector<std::atomic<int>> visits(n);
      parallel_for(n, threads, [&](size_t i) { ++visits[i]; });
      size_t once = 0;
      for (const auto& v : visits) once += v == 1;
      CHECK(once == n);
    }
}

TEST_CASE("slots are in range and never shared by two bodies at a time") {
  for (int threads = 1; threads <= 8; ++threads) {
    std::vector<std::atomic<int>> inside(size_t(thread_count(threads)));
    std::atomic<int> clashes = 0, out_of_range = 0;
    parallel_for_slots(2000, threads, [&](size_t, size_t slot) {
      if (slot >= inside.size()) {
        ++out_of_range;
        return;
      }
      if (inside[slot].fetch_add(1) != 0) ++clashes;
      std::this_thread::yield();
      --inside[slot];
    });
    CHECK(clashes == 0);
    CHECK(out_of_range == 0);
  }
}

TEST_CASE("an exception in a parallel loop reaches the caller") {
  for (int threads = 1; threads <= 8; ++threads)
    CHECK_THROWS_WITH_AS(parallel_for(100, threads,
                                      [](size_t i) {
                                        if (i == 37) throw std::runtime_error("item 37");
                                      }),
                         "item 37", std::runtime_error);
}

TEST_CASE("zero threads means all cores") {
  CHECK(thread_count(0) >= 1);
  CHECK(thread_count(5) == 5);
}

TEST_CASE("warnings are counted, and bounded in number") {
  WarningLog log;
  log.add("odd");
  log.add("other", 3);
  log.add("odd", 2);
  log.add("never", 0);
  REQUIRE(log.entries().size() == 2);
  CHECK(log.entries()[0].text == "odd");
  CHECK(log.entries()[0].count == 3);
  CHECK(log.total() == 6);
  for (int i = 0; i < 1000; ++i) log.add("kind " + std::to_string(i));
  CHECK(log.entries().size() <= 201);
  CHECK(log.total() == 1006);
}

TEST_CASE("input errors say where") {
  const InputError with_line("a.pbrt", 12, 5, "unknown directive 'Foo'");
  CHECK(std::string(with_line.what()) == "a.pbrt:12:5: unknown directive 'Foo'");
  CHECK(with_line.line() == 12);
  CHECK(with_line.column() == 5);
  CHECK(with_line.file() == "a.pbrt");
  CHECK(with_line.reason() == "unknown directive 'Foo'");
  CHECK(std::string(InputError("a.glb", 0, 0, "truncated").what()) == "a.glb:1:1: truncated");
  CHECK(std::string(InputError("", 0, 0, "no scene").what()) == "no scene");
}
