#include "image/write_image.h"

#include <cctype>
#include <cstring>
#include <new>

#include "base/error.h"
#include "image/atomic_file.h"
#include "image/encode.h"
#include "image/output_set.h"
#include "image/output_target.h"
#include "image/rgbe.h"

namespace troffer {

namespace {

void append(std::vector<uint8_t>& out, const std::string& text) {
  out.insert(out.end(), text.begin(), text.end());
}

// Appends one component of a scan line: runs of at least four equal bytes as (128 + n, value),
// other bytes as (n, bytes) [1].
void append_runs(std::vector<uint8_t>& out, std::span<const uint8_t> v) {
  constexpr size_t shortest_run = 4, longest_run = 127, longest_dump = 128;
  const auto run_at = [&](size_t i) {
    size_t n = 1;
    while (n < longest_run && i + n < v.size() && v[i + n] == v[i]) ++n;
    return n;
  };
  for (size_t i = 0; i < v.size();) {
    size_t end = i, run = 0;  // [i, end) is stored as is, then a run follows
    while (end < v.size() && (run = run_at(end)) < shortest_run) end += run;
    if (end == v.size()) run = 0;
    while (i < end) {
      const size_t n = std::min(end - i, longest_dump);
      out.push_back(uint8_t(n));
      out.insert(out.end(), v.begin() + std::ptrdiff_t(i), v.begin() + std::ptrdiff_t(i + n));
      i += n;
    }
    if (run > 0) {
      out.push_back(uint8_t(128 + run));
      out.push_back(v[i]);
      i += run;
    }
  }
}

std::vector<uint8_t> encode(ImageFormat format, std::span<const Layer> layers,
                            const WriteOptions& options) {
  switch (format) {
    case ImageFormat::exr:
      return encode_exr(layers, options.window, options.note);
    case ImageFormat::hdr:
      return encode_hdr(layers[0].image);
    case ImageFormat::pfm:
      return encode_pfm(layers[0].image);
    case ImageFormat::png:
      break;
  }
  return encode_png(layers[0].image, options.display, options.threads);
}

// True for a pipe, a device or an open file of this process: its name need not state a format.
bool takes_any_format(const std::string& path) {
  try {
    return output_target(path).kind != OutputTarget::Kind::file;
  } catch (const EnvironmentError&) {
    return false;
  }
}

}  // namespace

ImageFormat image_format(const std::string& path) {
  const size_t dot = path.rfind('.');
  std::string ending = dot == path.npos ? "" : path.substr(dot + 1);
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (ending == "exr") return ImageFormat::exr;
  if (ending == "hdr") return ImageFormat::hdr;
  if (ending == "pfm") return ImageFormat::pfm;
  if (ending == "png") return ImageFormat::png;
  if (takes_any_format(path)) return ImageFormat::exr;
  throw UsageError("unknown picture format: " + path + " (use .exr, .hdr, .pfm or .png)");
}

std::vector<uint8_t> encode_hdr(const Image& image) {
  const auto width = size_t(image.width);
  const bool has_runs = width >= 8 && width <= 0x7fff;  // else flat pixels [1]
  std::vector<uint8_t> out;
  append(out, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) + " +X " +
                  std::to_string(image.width) + "\n");
  std::vector<uint8_t> components(4 * width);
  for (int y = 0; y < image.height; ++y) {
    for (size_t x = 0; x < width; ++x) {
      const auto p = rgbe_from_rgb(image.at(int(x), y));
      for (size_t c = 0; c < 4; ++c) components[has_runs ? c * width + x : 4 * x + c] = p[c];
    }
    if (!has_runs) {
      out.insert(out.end(), components.begin(), components.end());
      continue;
    }
    for (const size_t v : {size_t(2), size_t(2), width >> 8, width & 255})
      out.push_back(uint8_t(v));
    for (size_t c = 0; c < 4; ++c)
      append_runs(out, std::span(components).subspan(c * width, width));
  }
  return out;
}

std::vector<uint8_t> encode_pfm(const Image& image) {
  std::vector<uint8_t> out;
  append(out,
         "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n");
  const size_t row = size_t(image.width) * sizeof(Rgb), header = out.size();
  out.resize(header + row * size_t(image.height));
  for (int y = 0; y < image.height; ++y)
    std::memcpy(out.data() + header + size_t(image.height - 1 - y) * row, &image.at(0, y), row);
  return out;
}

std::vector<uint8_t> encode_image(const std::string& path, std::span<const Layer> layers,
                                  const WriteOptions& options) {
  const ImageFormat format = image_format(path);
  TROFFER_CHECK(!layers.empty());
  for (const Layer& layer : layers) {
    TROFFER_CHECK(layer.image.width == layers[0].image.width && layer.image.width > 0);
    TROFFER_CHECK(layer.image.height == layers[0].image.height && layer.image.height > 0);
    TROFFER_CHECK(layer.channels.size() == 1 || layer.channels.size() == 3);
  }
  try {
    return encode(format, layers, options);
  } catch (const std::bad_alloc&) {
    throw EnvironmentError("cannot write " + path + ": not enough memory");
  }
}

void write_image(const std::string& path, std::span<const Layer> layers,
                 const WriteOptions& options) {
  image_format(path);
  AtomicFile file(path);
  file.write(encode_image(path, layers, options));
  if (options.is_safe)
    file.commit_to_disk();
  else
    file.commit();
}

void write_image(const std::string& path, const Image& image, const WriteOptions& options) {
  const Layer layer{"", {"R", "G", "B"}, image};
  write_image(path, std::span(&layer, 1), options);
}

}  // namespace troffer
