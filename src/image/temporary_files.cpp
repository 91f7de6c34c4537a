#include "image/temporary_files.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

namespace troffer {

namespace {

// A signal handler reaches nothing but globals, and must not wait for a lock or allocate: fixed
// slots, each of which one thread claims. Few files are written at a time; one that finds no slot
// is only not looked after.
enum class SlotState : int { free, claimed, full };
struct Slot {
  std::atomic<SlotState> state = SlotState::free;
  char path[PATH_MAX] = {};
};
static_assert(std::atomic<SlotState>::is_always_lock_free);
Slot slots[16];
std::atomic<bool> is_over = false;

}  // namespace

TemporaryFile::TemporaryFile(const std::string& path) {
  if (path.size() >= sizeof(Slot::path)) return;
  for (size_t i = 0; i < std::size(slots); ++i) {
    SlotState expected = SlotState::free;
    if (!slots[i].state.compare_exchange_strong(expected, SlotState::claimed)) continue;
    std::memcpy(slots[i].path, path.c_str(), path.size() + 1);
    slots[i].state = SlotState::full;
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
  if (slot_ != none) slots[slot_].state = SlotState::free;
  slot_ = none;
}

void remove_temporary_files() noexcept {
  const int error = errno;
  is_over = true;
  for (const Slot& slot : slots)
    if (slot.state == SlotState::full) unlink(slot.path);
  errno = error;
}

bool are_temporary_files_removed() noexcept {
  return is_over;
}

}  // namespace troffer
