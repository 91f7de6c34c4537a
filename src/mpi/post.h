// How letters get from process to process: a few functions, so that the schedule can be tested
// without MPI.
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

// Letters between two processes may overtake each other; of one that has died none come, and what
// is sent to it is lost.
class Post {
 public:
  using Bytes = std::shared_ptr<const std::vector<uint8_t>>;

  virtual ~Post() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  // By one thread at a time. None of them waits.
  virtual std::optional<Message> receive() = 0;
  virtual void send(int to, Bytes bytes) = 0;
  // Something large is on its way, and gets on whenever this is called.
  virtual bool is_moving() = 0;
};

}  // namespace troffer
