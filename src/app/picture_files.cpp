#include "app/picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "image/exposure.h"
#include "image/output_target.h"
#include "render/camera.h"

namespace troffer {

namespace {

// The exposure of .png: as asked for; `auto` by the picture, which by itself is taken where without
// one it would come out nearly black or white.
double exposure_stops(const RenderCommand& c, const Image& picture, bool is_quiet) {
  constexpr double most_stops_off = 4;
  const Brightness b = brightness(picture);
  if (b.is_black && !is_quiet)
    fmt::print(stderr, "warning: the picture is black: no light reaches what the camera sees\n");
  if (!c.exposure.empty() && c.exposure != "auto") return std::strtod(c.exposure.c_str(), nullptr);
  if (c.exposure == "auto") return b.auto_stops;
  const bool is_shown = std::any_of(c.outputs.begin(), c.outputs.end(), [](const std::string& o) {
    return image_format(o) == ImageFormat::png;
  });
  if (!is_shown || std::abs(b.auto_stops) <= most_stops_off) return 0;
  if (!is_quiet)
    fmt::print(stderr,
               "warning: the .png is exposed by {:+.1f} stops (--exposure chooses another)\n",
               b.auto_stops);
  return b.auto_stops;
}

}  // namespace

WriteOptions write_options(const RenderCommand& c, const Camera& camera, const Image& picture,
                           bool is_quiet) {
  WriteOptions write;
  write.display = {exposure_stops(c, picture, is_quiet),
                   c.tone_map == "none" ? ToneMap::none : ToneMap::filmic};
  write.threads = c.options.threads;
  if (c.options.has_crop) {
    const ImageSize whole = image_size(camera, c.options.width, c.options.height);
    write.window = {c.options.crop[0], c.options.crop[1], whole.width, whole.height};
  }
  return write;
}

void PreviewFiles::write(const Image& picture) {
  WriteOptions options = write_options(command_, camera_, picture, true);
  options.threads = 1;  // of a loop over tiles, whose other threads go on
  for (const std::string& path : command_.outputs) {
    if (output_target(path).kind != OutputTarget::Kind::file) continue;
    write_image(path, picture, options);
    if (std::find(written_.begin(), written_.end(), path) == written_.end())
      written_.push_back(path);
  }
}

PreviewFiles::~PreviewFiles() {
  std::error_code ignored;  // there is another failure to tell
  for (const std::string& path : written_) std::filesystem::remove(path, ignored);
}

}  // namespace troffer
