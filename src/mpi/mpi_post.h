// Letters by MPI: the only place that calls it.
#pragma once

#include <memory>

#include "mpi/post.h"

namespace troffer {

class MpiPost final : public Post {
 public:
  // Between MPI_Init and MPI_Finalize, once in a program. Throws EnvironmentError where MPI cannot
  // be called from a thread of the program's own.
  MpiPost(int& argc, char**& argv);
  ~MpiPost() override;
  // Ends MPI; nothing is sent or received after it. Where MPI does not come to an end because
  // somebody died, the program does, with this status.
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
