// Processes that work on one thing together, as threads do within one. All of them have the same
// input and call the same functions below in the same order (what else they do is the same too, so
// that they come to the same); rank 0 leads: what only one is to do, it does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/own_file.h"
#include "base/parallel.h"

namespace troffer {

// Items 0 … items - 1, each done by one process, or by several to the same end.
struct SharedWork {
  using Bytes = std::vector<uint8_t>;

  size_t items = 0;
  int threads = 0;  // of this process; 0 = all cores
  // Does one: must write to places that depend on the item only. slot: as in parallel_for_slots.
  // False where it was broken off, for a stop.
  std::function<bool(size_t item, size_t slot)> act;
  // What came of it, as bytes; by the thread that did it.
  std::function<void(size_t item, Bytes& out)> save;
  // … as others have it then. One at a time, by any thread, while others act on other items.
  std::function<void(size_t item, ByteReader in)> load;
  // All get what came of the items; else rank 0 alone.
  bool is_for_all = true;

  // Of rank 0, where not all items are to be done, or some before others: which, in order.
  bool has_order = false;
  std::vector<size_t> order;
  // What rank 0 tells of an item to whoever is to do it; may be empty. One at a time, by any
  // thread, while no thread of rank 0 acts on that item.
  std::function<void(size_t item, Bytes& out)> brief;
  // … is told so, by the thread that will do it.
  std::function<void(size_t item, ByteReader in)> take_brief;
};

class ProcessGroup {
 public:
  virtual ~ProcessGroup() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  bool leads() const { return rank() == 0; }

  // Once it returns, all is done, and what came of it is where it is to be. False where work is to
  // end: `stop` of rank 0 was set. (Others look at it too: theirs is to be stop_flag().)
  virtual bool share(const SharedWork& work, const StopFlag& stop) = 0;
  // All get the bytes that rank 0 has. False as above.
  virtual bool tell(SharedWork::Bytes& bytes, const StopFlag& stop) = 0;
  // Set once work is to end: by rank 0, or because one of the processes was asked to.
  virtual const StopFlag& stop_flag() const = 0;
  // `asked`, which must outlive this, is set where this process is asked to end the work.
  virtual void watch(const StopFlag& asked) = 0;
  // This process can take no part any more.
  virtual void leave(const std::string& why) = 0;
  // That this process should use where nobody says how many.
  virtual int usual_threads() const = 0;
};

// crew: null: this process alone does all of it, in order. False once `stop` is set.
bool share(ProcessGroup* group, const SharedWork& work, const StopFlag& stop);

// Plain data, their number first.
template <class T>
void append_all(std::vector<uint8_t>& out, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  append(out, uint64_t(values.size()));
  const size_t at = out.size();
  out.resize(at + values.size_bytes());
  if (!values.empty()) std::memcpy(out.data() + at, values.data(), values.size_bytes());
}

template <class T>
std::vector<T> next_all(ByteReader& in) {
  const auto count = in.next<uint64_t>();
  TROFFER_CHECK(count <= in.left() / sizeof(T));
  std::vector<T> values(count);
  for (T& v : values) v = in.next<T>();
  return values;
}

}  // namespace troffer
