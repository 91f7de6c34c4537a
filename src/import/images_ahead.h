// Images that an importer knows it will ask for, decoded on other threads meanwhile.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "image/raster.h"

namespace troffer {

// Changes when images are decoded, and nothing else. Nobody expects while another expects or takes.
class ImagesAhead {
 public:
  // `threads` others decode; 0: none does, and take() has nothing. Of what was decoded and has not
  // been taken they keep about `most_bytes`, and an image each beyond that.
  explicit ImagesAhead(int threads, uint64_t most_bytes = uint64_t(512) << 20);
  ~ImagesAhead();  // what nobody has begun is dropped; what is being decoded is waited for
  ImagesAhead(const ImagesAhead&) = delete;
  ImagesAhead& operator=(const ImagesAhead&) = delete;

  // `decode` is called once at most, on any thread, before this ends. A key that was expected
  // before changes nothing.
  using Decode = std::function<Raster()>;
  void expect(const std::string& key, Decode decode);

  // What decode() gave; nothing where it threw, or nobody has begun it (nobody will then), or it
  // was not expected, or has been taken.
  std::optional<Raster> take(const std::string& key);

 private:
  enum class State : uint8_t { waiting, begun, done, gone };
  struct Image {
    Decode decode;
    State state = State::waiting;
    Raster raster;
  };

  void work();
  // The next that waits; false: there is none, or too much is kept.
  bool decode_one(std::unique_lock<std::mutex>& lock);

  uint64_t most_bytes_;
  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::map<std::string, Image> images_;
  std::deque<Image*> waiting_;  // those that wait, and some that are gone
  uint64_t kept_bytes_ = 0;
  bool is_ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace troffer
