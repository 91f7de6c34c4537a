// Pictures of a rendering that is not done yet: a coarse one at once, then what is finished so far.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>

#include "base/parallel.h"
#include "image/image.h"
#include "render/film.h"
#include "render/render.h"

namespace troffer {

// How soon pictures follow each other, and what the first ones take.
struct PreviewPace {
  // Seconds from one picture to the next; more where showing one takes longer than a tenth of it.
  double interval = 2;
  double look_seconds = 0.8;  // of look(), about
  int first_blocks = 64;      // of the first picture, along its longer side
};

// None of it changes the picture that is made in the end.
class Preview {
 public:
  // Gets what is to be shown, of the size of the window that is rendered; called from one thread at
  // a time, whichever it is.
  using Show = std::function<void(const Image&)>;
  explicit Preview(Show show, const PreviewPace& pace = {}) : show_(std::move(show)), pace_(pace) {}

  // Of a scene for which a tracer takes a while to build, or for which images are yet to be read,
  // at once: a grey picture (first_sight.h).
  void sight(const Scene& scene, const Camera& camera, const RenderOptions& options,
             bool waits_for_images);

  // A coarse picture by few paths: shown as soon as there is one, and again when it has become as
  // fine as about a second allows. The options must be fine (check_options).
  void look(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
            const StopFlag& stop);

  // In place of look(): goes on from a picture that there is, of the size of the window.
  void go_on_from(const Image& coarse, const PixelRect& window);

  // Takes the pixels of a tile that have samples over the coarse ones; shows the picture where the
  // last one has stood for a while. Any number of threads, as long as nobody adds to this tile.
  void update(const Film& film, const PixelRect& tile);

  // The picture that was shown last or is about to be; empty before look() has made a picture.
  // While nobody updates.
  const Image& picture() const { return image_; }

 private:
  using Clock = std::chrono::steady_clock;
  void show(const Image& image);

  Show show_;
  PreviewPace pace_;
  PixelRect window_;
  Image image_;  // empty: nobody has looked yet
  std::mutex mutex_;
  bool is_showing_ = false;
  Clock::time_point next_;  // not before this
};

}  // namespace troffer
