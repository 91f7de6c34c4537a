#include "import/images_ahead.h"

#include <system_error>
#include <utility>

namespace troffer {

namespace {

uint64_t bytes_of(const Raster& raster) {
  return raster.texels8.size() + raster.texels_float.size() * sizeof(float);
}

}  // namespace

ImagesAhead::ImagesAhead(int threads, uint64_t most_bytes) : most_bytes_(most_bytes) {
  try {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    return;  // work with the threads that exist
  }
}

ImagesAhead::~ImagesAhead() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ImagesAhead::expect(const std::string& key, Decode decode) {
  if (threads_.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    const auto [it, is_new] = images_.try_emplace(key);
    if (!is_new) return;
    it->second.decode = std::move(decode);
    waiting_.push_back(&it->second);
  }
  changed_.notify_all();
}

std::optional<Raster> ImagesAhead::take(const std::string& key) {
  std::unique_lock lock(mutex_);
  const auto it = images_.find(key);
  if (it == images_.end()) return std::nullopt;
  Image& image = it->second;
  // Threads that decode do not wait for space, so this loop ends. Decoding other images meanwhile
  // keeps this thread busy.
  while (image.state == State::begun)
    if (!decode_one(lock)) changed_.wait(lock);
  const State state = std::exchange(image.state, State::gone);
  image.decode = nullptr;
  if (state != State::done) return std::nullopt;
  kept_bytes_ -= bytes_of(image.raster);
  changed_.notify_all();
  return std::exchange(image.raster, {});
}

bool ImagesAhead::decode_one(std::unique_lock<std::mutex>& lock) {
  while (!waiting_.empty() && waiting_.front()->state != State::waiting) waiting_.pop_front();
  if (waiting_.empty() || kept_bytes_ > most_bytes_) return false;
  Image& image = *waiting_.front();
  waiting_.pop_front();
  image.state = State::begun;
  const Decode decode = std::exchange(image.decode, nullptr);
  lock.unlock();
  std::optional<Raster> raster;
  try {
    raster = decode();
  } catch (...) {
    // The caller decodes it again and gets the error; memory may suffice then.
  }
  lock.lock();
  image.state = raster ? State::done : State::gone;
  if (raster) {
    kept_bytes_ += bytes_of(*raster);
    image.raster = std::move(*raster);
  }
  changed_.notify_all();
  return true;
}

void ImagesAhead::work() {
  std::unique_lock lock(mutex_);
  while (!is_ending_)
    if (!decode_one(lock)) changed_.wait(lock);
}

}  // namespace troffer
