// The one thread of a process that sends and receives messages. Leader and Follower each own one.
// It polls, because MPI offers no blocking wait that does not use a processor.
#pragma once

#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "mpi/post.h"

namespace troffer {

class MessageTransport {
 public:
  // Callbacks of that thread: for each message, and at least every millisecond.
  using Receive = std::function<void(Message&&)>;
  using Tick = std::function<void()>;

  MessageTransport(Post& post, Receive receive, Tick tick);
  ~MessageTransport() { end(); }
  MessageTransport(const MessageTransport&) = delete;
  MessageTransport& operator=(const MessageTransport&) = delete;

  // Sends a message; callable from any thread.
  void send(int to, Post::Bytes bytes);
  // Sends the remaining messages and ends the thread.
  void end();

 private:
  void work();
  bool send_waiting();

  Post& post_;
  Receive receive_;
  Tick tick_;
  std::mutex mutex_;
  std::vector<std::pair<int, Post::Bytes>> waiting_;
  bool is_ending_ = false;
  std::thread thread_;  // last: it uses all other members
};

}  // namespace troffer
