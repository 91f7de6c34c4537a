// Preview of a rendering in progress: a coarse picture at once, then the picture so far. Used by
// the commands render and view. The final picture does not depend on it.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>

#include "base/parallel.h"
#include "image/image.h"
#include "render/film.h"
#include "render/render.h"

namespace troffer {

// Time and detail of previews.
struct PreviewPace {
  // Seconds from one picture to the next; more if showing one takes longer than a tenth of it.
  double interval = 2;
  double look_seconds = 0.8;  // approximate duration of look()
  int first_blocks = 64;      // blocks of the first picture along its longer side
};

// Shows pictures of unfinished work. Only update() may be called concurrently.
class Preview {
 public:
  // Receives the picture to show, of the size of the rendered window. Called from one thread at a
  // time, but not always the same.
  using Show = std::function<void(const Image&)>;
  explicit Preview(Show show, const PreviewPace& pace = {}) : show_(std::move(show)), pace_(pace) {}

  // Shows a grey picture at once (first_sight.h) if building a tracer takes a while or images are
  // still to be read.
  void sight(const Scene& scene, const Camera& camera, const RenderOptions& options,
             bool waits_for_images);

  // Shows a coarse picture by few paths as soon as there is one, and a finer one after about
  // PreviewPace::look_seconds. The options must be valid (check_options).
  void look(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
            const StopFlag& stop);

  // Replaces look(): continues from an existing picture of the window's size.
  void go_on_from(const Image& coarse, const PixelRect& window);

  // Replaces coarse pixels by those of a tile that have samples. Shows the picture if the last one
  // is old enough. Any thread may call it, as long as no other thread changes this tile.
  void update(const Film& film, const PixelRect& tile);

  // Returns the latest picture, whether it has been shown or not; empty before the first look().
  // Must not be called during update().
  const Image& picture() const { return image_; }

 private:
  using Clock = std::chrono::steady_clock;
  void show(const Image& image);

  Show show_;
  PreviewPace pace_;
  PixelRect window_;
  Image image_;  // empty before the first look()
  std::mutex mutex_;
  bool is_showing_ = false;
  Clock::time_point next_;  // earliest time of the next picture
};

}  // namespace troffer
