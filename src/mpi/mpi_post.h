// Post (post.h) over MPI; no other code calls MPI. troffer-mpi makes one per process. Messages are
// non-blocking; messages to dead processes are dropped.
#pragma once

#include <memory>

#include "mpi/post.h"

namespace troffer {

class MpiPost final : public Post {
 public:
  // Calls MPI_Init; make one per program. Throws EnvironmentError if this MPI does not support
  // calls from a thread of the program.
  MpiPost(int& argc, char**& argv);
  ~MpiPost() override;
  // Calls MPI_Finalize; nothing is sent or received afterwards. If that hangs because a process
  // died, the program exits with this status.
  void close(int status);
  MpiPost(const MpiPost&) = delete;
  MpiPost& operator=(const MpiPost&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  std::optional<Message> receive() override;
  void send(int to, Bytes bytes) override;
  bool is_moving() override;

 private:
  struct Moving;
  int rank_ = 0, size_ = 1;
  bool is_closed_ = false;
  std::unique_ptr<Moving> moving_;
};

}  // namespace troffer
