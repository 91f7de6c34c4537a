// The one thread of a process that sends and receives.
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
  // Both are called by the thread: for each letter, and again and again, at most a millisecond
  // apart.
  using Receive = std::function<void(Message&&)>;
  using Tick = std::function<void()>;

  MessageTransport(Post& post, Receive receive, Tick tick);
  ~MessageTransport() { end(); }
  MessageTransport(const MessageTransport&) = delete;
  MessageTransport& operator=(const MessageTransport&) = delete;

  // By any thread.
  void send(int to, Post::Bytes bytes);
  // Sends what is left, and ends the thread.
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
  std::thread thread_;  // last: it uses all the others
};

}  // namespace troffer
