// Processes that share work, as threads do within one process. Implemented for MPI. All processes
// have the same input and call the same functions in the same order. Rank 0 leads: it does what
// only one process may do. Used by renderers and solvers; docs/reference/mpi.md has the usage.
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

// Work on items 0 to items - 1. Each item is done by one process, or by several with the same
// result.
struct SharedWork {
  using Bytes = std::vector<uint8_t>;

  size_t items = 0;
  int threads = 0;  // threads of this process; 0 = all cores
  // Does one item; it may only write to places that depend on the item. `slot` is as in
  // parallel_for_slots. Returns false if a stop interrupted it.
  std::function<bool(size_t item, size_t slot)> act;
  // Appends the item's result as bytes. Called by the thread that did the item.
  std::function<void(size_t item, Bytes& out)> save;
  // Restores an item from the bytes of `save`. Called serially, from any thread, while other items
  // are being worked on.
  std::function<void(size_t item, ByteReader in)> load;
  // True if all processes get the results; otherwise only rank 0 does.
  bool is_for_all = true;

  // Rank 0 only: `order` lists the items to do, in order, instead of all of them.
  bool has_order = false;
  std::vector<size_t> order;
  // Rank 0 appends data for the process that will do the item; may be empty. Called serially, from
  // any thread, while no thread of rank 0 works on that item.
  std::function<void(size_t item, Bytes& out)> brief;
  // Receives the bytes of `brief`, on the thread that will do the item.
  std::function<void(size_t item, ByteReader in)> take_brief;
};

class ProcessGroup {
 public:
  virtual ~ProcessGroup() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  bool leads() const { return rank() == 0; }

  // Returns after all items are done and the results are distributed. Returns false if rank 0's
  // `stop` was set. Other processes must pass stop_flag() as `stop`.
  virtual bool share(const SharedWork& work, const StopFlag& stop) = 0;
  // Sends rank 0's bytes to all processes. Returns false as above.
  virtual bool tell(SharedWork::Bytes& bytes, const StopFlag& stop) = 0;
  // Set when the work is to end: by rank 0, or because a process was asked to.
  virtual const StopFlag& stop_flag() const = 0;
  // Registers a flag that asks this process to end the work. It must outlive this object.
  virtual void watch(const StopFlag& asked) = 0;
  // Withdraws this process after an error; it takes no further part.
  virtual void leave(const std::string& why) = 0;
  // Number of threads for this process if the user gives none.
  virtual int default_threads() const = 0;
};

// Shares the work with the group. Without group (null), this process does all items in order.
// Returns false once `stop` is set.
bool share(ProcessGroup* group, const SharedWork& work, const StopFlag& stop);

// append_all() writes the number of values and the values, plain data; next_all() reads them.
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
