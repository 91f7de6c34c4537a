// Picture: pixels, layers, statistics, files.
#include <utility>

#include "api/picture_impl.h"
#include "api/values.h"
#include "base/error.h"
#include "base/suggestion.h"
#include "image/encode.h"
#include "image/write_image.h"

namespace troffer::api {

namespace {

PixelView view_of(const Layer& layer) {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const troffer::Image& image = layer.image;
  return {image.pixels.empty() ? nullptr : &image.pixels.data()->r, image.width, image.height,
          int(layer.channels.size()), 3};
}

const Layer* find_layer(const RenderResult& result, const std::string& name) {
  for (size_t i = 1; i < result.layers.size(); ++i)
    if (result.layers[i].name == name) return &result.layers[i];
  return nullptr;
}

const char* name_of(RenderEnd end) {
  switch (end) {
    case RenderEnd::complete:
      return "complete";
    case RenderEnd::good_enough:
      return "good_enough";
    case RenderEnd::out_of_time:
      return "out_of_time";
    case RenderEnd::stopped:
      return "stopped";
  }
  return "";
}

}  // namespace

RenderStatistics statistics_of(const RenderResult& result, double build_seconds) {
  const troffer::RenderStatistics& from = result.statistics;
  RenderStatistics s;
  s.width = from.width;
  s.height = from.height;
  s.end = name_of(result.end);
  s.build_seconds = build_seconds;
  s.preprocess_seconds = from.preprocess_seconds;
  s.render_seconds = from.render_seconds;
  s.estimated_error = from.estimated_error;
  s.viewing_error = from.viewing_errors.relative_rms;
  s.share_above = from.viewing_errors.share_above;
  s.share_done = from.share_done;
  s.gaps_filled = from.gaps_filled;
  s.unsampled = from.unsampled;
  s.viewing_rays = from.counters.viewing_rays;
  s.surrogate_samples = from.counters.surrogates;
  s.extension_rays = from.counters.extension_rays;
  s.shadow_rays = from.counters.shadow_rays;
  s.nan_samples = from.counters.nan_samples;
  s.lit_certified = from.counters.lit_certified;
  s.dark_certified = from.counters.dark_certified;
  s.masked = from.counters.masked;
  s.mixed = from.counters.mixed;
  s.is_by_paths = from.is_by_paths;
  s.cells = from.cells.cells;
  s.cell_rays = from.cells.rays;
  s.cell_size = from.cells.size;
  s.cell_seconds = from.cells.seconds;
  s.cell_bytes = from.cells.bytes;
  return s;
}

int Picture::width() const {
  return pixels().width;
}
int Picture::height() const {
  return pixels().height;
}
PixelView Picture::pixels() const {
  return view_of(impl_->result.layers.front());
}

Image Picture::image() const {
  const PixelView v = pixels();
  const size_t numbers = 3 * size_t(v.width) * size_t(v.height);
  return {v.width, v.height, std::vector<float>(v.data, v.data + numbers)};
}

std::vector<std::string> Picture::layer_names() const {
  std::vector<std::string> names;
  for (size_t i = 1; i < impl_->result.layers.size(); ++i)
    names.push_back(impl_->result.layers[i].name);
  return names;
}

bool Picture::has_layer(const std::string& name) const {
  return find_layer(impl_->result, name) != nullptr;
}

PixelView Picture::layer(const std::string& name) const {
  const Layer* const found = find_layer(impl_->result, name);
  if (found == nullptr)
    throw UsageError("the picture has no layer '" + name + "'" + did_you_mean(name, layer_names()));
  return view_of(*found);
}

const RenderStatistics& Picture::statistics() const {
  return impl_->statistics;
}
bool Picture::is_complete() const {
  return impl_->result.is_complete;
}

void Picture::save(const std::string& path, const DisplayOptions& display) const {
  const std::vector<Layer>& layers = impl_->result.layers;
  WriteOptions options;
  options.display = display_of(display, layers.front().image);
  troffer::write_image(path, layers, options);
}

std::vector<std::uint8_t> Picture::png(const DisplayOptions& display) const {
  const troffer::Image& image = impl_->result.layers.front().image;
  return encode_png(image, display_of(display, image), 0);
}

}  // namespace troffer::api
