#include "app/picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "app/printable.h"
#include "app/unfinished.h"
#include "image/exposure.h"
#include "image/output_target.h"
#include "render/camera.h"

namespace troffer {

namespace {

// Returns the stops for .png: as requested; for "auto" by the picture. Without a request, automatic
// exposure applies only if the picture would be nearly black or white.
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

void warn_of_layers(const RenderCommand& c) {
  const auto holds_layers = [](const std::string& path) {
    return image_format(path) == ImageFormat::exr;
  };
  if (!c.is_quiet && !c.options.aovs.empty() &&
      std::none_of(c.outputs.begin(), c.outputs.end(), holds_layers))
    fmt::print(stderr, "warning: --aov: {} cannot hold layers; write an .exr file too\n",
               printable(c.outputs.front()));
}

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

std::string PreviewFiles::file_for(const std::string& output) {
  for (const Shown& s : shown_)
    if (s.output == output) return s.file;
  const std::string file = place_for_unfinished(output);
  if (file != output && !command_.is_quiet)
    fmt::print(stderr, "{} is kept until the picture is finished; previews are written to {}\n",
               printable(output), printable(file));
  shown_.push_back({output, file});
  return file;
}

void PreviewFiles::write(const Image& picture) {
  WriteOptions options = write_options(command_, camera_, picture, true);
  options.threads = 1;  // the other threads of the loop over tiles keep rendering
  for (const std::string& path : command_.outputs)
    if (output_target(path).kind == OutputTarget::Kind::file)
      write_image(file_for(path), picture, options);
}

void PreviewFiles::is_finished(const std::string& path) {
  std::error_code ignored;  // a remaining preview does no harm
  for (const Shown& s : shown_)
    if (s.output == path && s.file != path) std::filesystem::remove(s.file, ignored);
  std::erase_if(shown_, [&](const Shown& s) { return s.output == path; });
}

std::string PreviewFiles::take_place(const std::string& path, bool is_kept) {
  const auto at =
      std::find_if(shown_.begin(), shown_.end(), [&](const Shown& s) { return s.output == path; });
  if (at == shown_.end()) return place_for_unfinished(path, is_kept);
  const std::string file = at->file;
  shown_.erase(at);
  return file;
}

PreviewFiles::~PreviewFiles() {
  std::error_code ignored;  // another failure is being reported
  for (const Shown& s : shown_) std::filesystem::remove(s.file, ignored);
}

}  // namespace troffer
