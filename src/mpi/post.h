// Transport of messages between processes: a small interface, so that the scheduling can be tested
// without MPI. MpiPost implements it with MPI; tests implement it with threads
// (tests/mpi/office.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace troffer {

struct Message {
  int from = 0;
  std::vector<uint8_t> bytes;
};

// Messages between two processes may overtake each other. A dead process sends none, and messages
// to it are lost.
class Post {
 public:
  using Bytes = std::shared_ptr<const std::vector<uint8_t>>;

  virtual ~Post() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  // Called by one thread at a time. No function blocks.
  virtual std::optional<Message> receive() = 0;
  virtual void send(int to, Bytes bytes) = 0;
  // True while a large message is under way; calling it drives the transfer.
  virtual bool is_moving() = 0;
};

}  // namespace troffer
