// Decoding of images in advance, on other threads, while an importer works on. TextureLoader uses
// it.
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

// Decodes expected images in advance. It affects only when images are decoded, not the result.
// expect() must not run concurrently with expect() or take().
class ImagesAhead {
 public:
  // Starts `threads` threads; with 0, take() returns nothing. The threads stop once decoded images
  // that were not taken exceed `most_bytes`; each may finish one more image.
  explicit ImagesAhead(int threads, uint64_t most_bytes = uint64_t(512) << 20);
  ~ImagesAhead();  // drops images not begun, and waits for those being decoded
  ImagesAhead(const ImagesAhead&) = delete;
  ImagesAhead& operator=(const ImagesAhead&) = delete;

  // Announces an image. `decode` is called at most once, on any thread, before this object ends. A
  // known key changes nothing.
  using Decode = std::function<Raster()>;
  void expect(const std::string& key, Decode decode);

  // Returns the decoded image, waiting if it is being decoded. Returns nothing if decode() threw,
  // decoding has not begun (it is then cancelled), or the key is unknown or already taken.
  std::optional<Raster> take(const std::string& key);

 private:
  enum class State : uint8_t { waiting, begun, done, gone };
  struct Image {
    Decode decode;
    State state = State::waiting;
    Raster raster;
  };

  void work();
  // Decodes the next waiting image; false if there is none or too much is kept.
  bool decode_one(std::unique_lock<std::mutex>& lock);

  uint64_t most_bytes_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::map<std::string, Image> images_;
  std::deque<Image*> waiting_;  // waiting images, and some that were cancelled
  uint64_t kept_bytes_ = 0;
  bool is_ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace troffer
