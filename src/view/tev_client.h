// Sends pictures to the viewer tev as they grow.
// References: [1] Müller, "tev", github.com/Tom94/tev: its protocol for other programs (packets
//   "create image" and "update image", version 3).
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "image/image.h"

namespace troffer {

class TevClient {
 public:
  // HOST:PORT, or HOST for port 14158. UsageError for what is neither, EnvironmentError where
  // nobody answers.
  explicit TevClient(const std::string& address);
  ~TevClient();
  TevClient(const TevClient&) = delete;
  TevClient& operator=(const TevClient&) = delete;

  // The picture is sent in the background, the newest where several wait; a connection that ends is
  // left alone.
  void show(const Image& picture);

 private:
  void run();
  bool send(const Image& picture);

  int socket_ = -1;
  int width_ = 0, height_ = 0;  // of the image that tev has
  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Image> next_;
  bool is_ending_ = false;
  std::thread thread_;  // last: it uses all the others
};

}  // namespace troffer
