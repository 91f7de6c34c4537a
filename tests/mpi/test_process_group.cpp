// Scheduling of shared work over several processes, also when some of them die.
#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <set>
#include <string>

#include "base/random.h"
#include "mpi/tree.h"
#include "office.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag never = false;

// Expected value of item i of a job.
uint64_t value_of(uint64_t job, size_t i) {
  return hash_of(job, uint64_t(i));
}

// A job whose items are numbers; `act` can be wrapped.
struct Numbers {
  Numbers(uint64_t job, size_t n) : values(n, 0) {
    work.items = n;
    work.threads = 2;
    work.act = [this, job](size_t i, size_t) {
      values[i] = value_of(job, i);
      ++acts;
      return true;
    };
    work.save = [this](size_t i, SharedWork::Bytes& out) {
      // Results have various lengths, including 0.
      for (size_t k = 0; k < i % 3; ++k) append(out, values[i]);
    };
    work.load = [this](size_t i, ByteReader in) {
      REQUIRE(in.left() == i % 3 * sizeof(uint64_t));
      values[i] = i % 3 == 0 ? 0 : in.next<uint64_t>();
    };
  }
  // Checks the items whose results are transmitted.
  bool are_right(uint64_t job) const {
    for (size_t i = 0; i < values.size(); ++i)
      if (i % 3 != 0 && values[i] != value_of(job, i)) return false;
    return true;
  }

  SharedWork work;
  std::vector<uint64_t> values;
  std::atomic<int> acts = 0;
};

}  // namespace

TEST_CASE("each message reaches every process once") {
  for (int size = 1; size <= 70; ++size) {
    std::vector<int> count(size_t(size), 0);
    std::vector<int> reached{0};
    while (!reached.empty()) {
      const int r = reached.back();
      reached.pop_back();
      ++count[size_t(r)];
      for (const int child : children_of(r, size)) reached.push_back(child);
    }
    for (const int c : count) CHECK(c == 1);
  }
}

TEST_CASE("every process learns what all have done") {
  for (const int size : {1, 2, 3, 8}) {
    Office office(size);
    std::array<std::atomic<int>, 4> acts{};
    run_group(office, nullptr, [&](ProcessGroup& group) {
      uint64_t job = 0;
      for (const size_t n : {size_t(0), size_t(1), size_t(40), size_t(3)}) {
        Numbers numbers(job, n);
        REQUIRE(group.share(numbers.work, never));
        CHECK(numbers.are_right(job));
        acts[job++] += numbers.acts;
      }
      std::vector<uint8_t> bytes;
      if (group.leads()) bytes.assign(20'000'000, 7);  // sent in several pieces
      REQUIRE(group.tell(bytes, never));
      CHECK(bytes == std::vector<uint8_t>(20'000'000, 7));
    });
    // Each item is done once, unless a process was very late.
    CHECK(acts[0] == 0);
    CHECK(acts[1] >= 1);
    CHECK(acts[2] >= 40);
    CHECK(acts[2] < 60);
  }
}

TEST_CASE("the process of an item gets its input; only rank 0 gets the result") {
  Office office(3);
  std::atomic<int> by_others = 0;
  run_group(office, nullptr, [&](ProcessGroup& group) {
    constexpr size_t n = 60;
    std::vector<uint64_t> state(n, group.leads() ? 5 : 0);
    SharedWork work;
    work.items = n;
    work.threads = 1;
    work.is_for_all = false;
    work.has_order = group.leads();
    std::vector<size_t> done;
    for (size_t i = 0; group.leads() && i < n; i += 2) work.order.push_back(n - 1 - i);
    work.brief = [&](size_t i, SharedWork::Bytes& out) { append(out, state[i]); };
    work.take_brief = [&](size_t i, ByteReader in) { state[i] = in.next<uint64_t>(); };
    work.act = [&](size_t i, size_t) {
      state[i] += i;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!group.leads()) ++by_others;
      return true;
    };
    work.save = [&](size_t i, SharedWork::Bytes& out) { append(out, state[i]); };
    work.load = [&](size_t i, ByteReader in) { state[i] = in.next<uint64_t>(); };
    REQUIRE(group.share(work, never));
    if (!group.leads()) return;
    for (size_t i = 0; i < n; ++i) CHECK(state[i] == (i % 2 == 1 ? 5 + i : 5));
  });
  CHECK(by_others > 0);
}

// Rank 1 forwards results to 3 and 5.
TEST_CASE("a process that dies loses only its items in progress") {
  Office office(6);
  std::atomic<int> by_dead = 0;
  run_group(office, nullptr, [&](ProcessGroup& group) {
    for (uint64_t job = 0; job < 3; ++job) {
      Numbers numbers(job, 200);
      const auto act = numbers.work.act;
      numbers.work.act = [&](size_t i, size_t slot) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (group.rank() == 1 && job == 1 && ++by_dead == 4) office.kill(1);
        return act(i, slot);
      };
      const bool is_done = group.share(numbers.work, never);
      if (group.rank() == 1 && by_dead >= 4) return;
      REQUIRE(is_done);
      CHECK(numbers.are_right(job));
    }
  });
  CHECK(by_dead >= 4);
}

TEST_CASE("a process that leaves is reported, and others take over its items") {
  Office office(4);
  std::vector<std::string> warnings;
  run_group(
      office, [&](const std::string& w) { warnings.push_back(w); },
      [&](ProcessGroup& group) {
        if (group.rank() == 2) return group.leave("no such file");
        for (uint64_t job = 0; job < 2; ++job) {
          Numbers numbers(job, 100);
          const auto act = numbers.work.act;
          numbers.work.act = [&](size_t i, size_t slot) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return act(i, slot);
          };
          REQUIRE(group.share(numbers.work, never));
          CHECK(numbers.are_right(job));
        }
      });
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0] == "process 2 does no work: no such file");
}

TEST_CASE("all processes stop, whichever is asked to") {
  for (const int asked_rank : {0, 1, 2}) {
    Office office(3);
    StopFlag asked = false;
    std::atomic<int> stopped = 0;
    run_group(office, nullptr, [&](ProcessGroup& group) {
      if (group.rank() == asked_rank) group.watch(asked);
      Numbers numbers(0, 1'000'000);
      const auto act = numbers.work.act;
      std::atomic<int> acts = 0;
      numbers.work.act = [&](size_t i, size_t slot) {
        if (group.rank() == asked_rank && ++acts == 5) asked = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return act(i, slot);
      };
      if (!group.share(numbers.work, group.stop_flag())) ++stopped;
      CHECK(group.stop_flag().load());
      std::vector<uint8_t> bytes;
      CHECK(!group.tell(bytes, group.stop_flag()));
      CHECK(!group.share(numbers.work, group.stop_flag()));
    });
    CHECK(stopped == 3);
  }
}

// The time limit is rank 0's own flag.
TEST_CASE("work that rank 0 cancels ends for all and is not taken for a signal") {
  Office office(3);
  StopFlag is_over = false;
  run_group(office, nullptr, [&](ProcessGroup& group) {
    Numbers numbers(0, 1'000'000);
    numbers.work.act = [&, act = numbers.work.act](size_t i, size_t slot) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (group.leads() && i > 20) is_over = true;
      return act(i, slot);
    };
    CHECK(!group.share(numbers.work, group.leads() ? is_over : group.stop_flag()));
    if (group.leads()) CHECK(!group.stop_flag().load());
  });
}

TEST_CASE("an error in an item affects only the process that does it") {
  Office office(3);
  run_group(office, nullptr, [&](ProcessGroup& group) {
    Numbers numbers(0, 100);
    numbers.work.act = [&, act = numbers.work.act](size_t i, size_t slot) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (group.rank() == 1) throw std::bad_alloc();
      return act(i, slot);
    };
    try {
      const bool is_done = group.share(numbers.work, never);
      CHECK(is_done);
      CHECK(group.rank() != 1);
      CHECK(numbers.are_right(0));
    } catch (const std::bad_alloc&) {
      CHECK(group.rank() == 1);
      group.leave("out of memory");
    }
  });
}
