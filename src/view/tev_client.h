// Sends pictures to the image viewer tev as they are refined. `troffer view --tev` uses it.
// References: [1] Müller, "tev", github.com/Tom94/tev: its protocol for other programs (packets
// "create image" and "update image", version 3).
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "image/image.h"

namespace troffer {

// A connection to tev, with a thread that sends. show() is thread-safe.
class TevClient {
 public:
  // address: HOST:PORT, or HOST for port 14158. Throws UsageError if it is neither,
  // EnvironmentError if nobody answers.
  explicit TevClient(const std::string& address);
  ~TevClient();
  TevClient(const TevClient&) = delete;
  TevClient& operator=(const TevClient&) = delete;

  // Sends a picture in the background. If several wait, only the newest is sent. Does nothing after
  // the connection has ended.
  void show(const Image& picture);

 private:
  void run();
  bool send(const Image& picture);

  int socket_ = -1;
  int width_ = 0, height_ = 0;  // size of the image in tev
  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Image> next_;
  bool is_ending_ = false;
  std::thread thread_;  // last member: its thread uses all others
};

}  // namespace troffer
