#include "image/temporary_files.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

namespace troffer {

namespace {

// A signal handler can access only globals and must not lock or allocate. Hence fixed slots, each
// claimed by one thread. A file that finds no slot is not registered. Paths and states are separate
// arrays, so that unused paths take no memory.
enum class SlotState : int { free, claimed, full };
constexpr size_t most_slots = 1024;
static_assert(std::atomic<SlotState>::is_always_lock_free);
std::atomic<SlotState> states[most_slots];
char paths[most_slots][PATH_MAX];
std::atomic<bool> is_over = false;

}  // namespace

TemporaryFile::TemporaryFile(const std::string& path) {
  if (path.size() >= PATH_MAX) return;
  for (size_t i = 0; i < most_slots; ++i) {
    SlotState expected = SlotState::free;
    if (!states[i].compare_exchange_strong(expected, SlotState::claimed)) continue;
    std::memcpy(paths[i], path.c_str(), path.size() + 1);
    states[i] = SlotState::full;
    slot_ = i;
    return;
  }
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : slot_(std::exchange(other.slot_, none)) {}

TemporaryFile& TemporaryFile::operator=(TemporaryFile&& other) noexcept {
  if (this != &other) {
    forget();
    slot_ = std::exchange(other.slot_, none);
  }
  return *this;
}

void TemporaryFile::forget() noexcept {
  if (slot_ != none) states[slot_] = SlotState::free;
  slot_ = none;
}

void remove_temporary_files() noexcept {
  const int error = errno;
  is_over = true;
  for (size_t i = 0; i < most_slots; ++i)
    if (states[i] == SlotState::full) unlink(paths[i]);
  errno = error;
}

bool are_temporary_files_removed() noexcept {
  return is_over;
}

}  // namespace troffer
