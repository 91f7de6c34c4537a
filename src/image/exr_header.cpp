#include "image/exr_header.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

#include "image/float_size.h"

namespace troffer {

namespace {

constexpr uint32_t tiled_flag = 0x200, deep_flag = 0x800, multipart_flag = 0x1000;
constexpr uint64_t max_buffer_bytes = uint64_t(1) << 28;
constexpr size_t max_channels = 1024;

// Attributes of one part that determine how much memory a reader allocates.
struct PartHeader {
  std::optional<std::array<int32_t, 4>> data_window;  // x0 y0 x1 y1, inclusive
  std::optional<std::array<uint32_t, 2>> tile_size;
  std::optional<uint8_t> compression;
  std::optional<uint64_t> bytes_per_pixel;
  std::string_view type;
};

class HeaderScanner {
 public:
  explicit HeaderScanner(const EncodedImage& encoded) : encoded_(encoded) {}

  uint32_t u32() {
    uint32_t v = 0;  // little-endian, as are the machines we run on
    std::memcpy(&v, take(4).data(), 4);
    return v;
  }
  uint8_t u8() { return take(1)[0]; }
  std::span<const uint8_t> take(size_t n) {
    if (n > left()) encoded_.fail("truncated EXR header");
    at_ += n;
    return encoded_.bytes.subspan(at_ - n, n);
  }
  // Reads a zero-terminated name of at most 255 characters.
  std::string_view name() {
    const size_t reach = std::min<size_t>(left(), 256);
    const uint8_t* begin = encoded_.bytes.data() + at_;
    const void* end = reach > 0 ? std::memchr(begin, 0, reach) : nullptr;
    if (end == nullptr) encoded_.fail("broken EXR header: name without an end");
    const auto n = size_t(static_cast<const uint8_t*>(end) - begin);
    at_ += n + 1;
    return {reinterpret_cast<const char*>(begin), n};
  }
  size_t left() const { return encoded_.bytes.size() - at_; }
  size_t at() const { return at_; }
  void seek(size_t at) { at_ = at; }

 private:
  const EncodedImage& encoded_;
  size_t at_ = 0;
};

// Returns the bytes per pixel over all channels of a chlist attribute that ends at `end` [1].
uint64_t channel_bytes(const EncodedImage& encoded, HeaderScanner& scanner, size_t end) {
  uint64_t bytes = 0;
  for (size_t n = 0; !scanner.name().empty(); ++n) {
    if (n == max_channels) encoded.fail("EXR of more than 1024 channels");
    bytes += scanner.u32() == 1 ? 2 : 4;  // half, else uint or float
    scanner.take(12);                     // linearity and sampling
    if (scanner.at() > end) encoded.fail("broken EXR header: channel list");
  }
  return bytes;
}

template <class T>
void set_once(const EncodedImage& encoded, std::optional<T>& slot, const T& value) {
  if (slot) encoded.fail("broken EXR header: attribute given twice");
  slot = value;
}

// Reads the attributes of one part, up to the empty name that ends them.
PartHeader read_part(const EncodedImage& encoded, HeaderScanner& scanner, std::string_view name) {
  PartHeader part;
  for (; !name.empty(); name = scanner.name()) {
    const std::string_view type = scanner.name();
    const uint32_t size = scanner.u32();
    if (size > scanner.left()) encoded.fail("truncated EXR header");
    const size_t end = scanner.at() + size;
    if (name == "dataWindow" && type == "box2i" && size == 16) {
      std::array<int32_t, 4> box{};
      std::memcpy(box.data(), scanner.take(16).data(), 16);
      set_once(encoded, part.data_window, box);
    } else if (name == "tiles" && type == "tiledesc" && size == 9) {
      const uint32_t x = scanner.u32();
      set_once(encoded, part.tile_size, {x, scanner.u32()});
    } else if (name == "compression" && type == "compression" && size == 1) {
      set_once(encoded, part.compression, scanner.u8());
    } else if (name == "channels" && type == "chlist") {
      set_once(encoded, part.bytes_per_pixel, channel_bytes(encoded, scanner, end));
    } else if (name == "type" && type == "string") {
      const auto text = scanner.take(size);
      part.type = {reinterpret_cast<const char*>(text.data()), text.size()};
    }
    scanner.seek(end);
  }
  return part;
}

// Returns the number of scan lines that are compressed together, by the compression's number [1].
uint64_t lines_per_chunk(uint8_t compression) {
  constexpr std::array<uint64_t, 10> lines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return compression < lines.size() ? lines[compression] : 256;
}

void check_part(const EncodedImage& encoded, const PartHeader& part, bool is_tiled_file) {
  if (part.type.starts_with("deep")) encoded.fail("EXR with deep data is not supported");
  if (!part.data_window || !part.compression || !part.bytes_per_pixel)
    encoded.fail("broken EXR header: dataWindow, channels or compression missing");
  const auto [x0, y0, x1, y1] = *part.data_window;
  if (x1 < x0 || y1 < y0) encoded.fail("EXR with an empty data window");
  const auto width = uint64_t(int64_t(x1) - x0 + 1), height = uint64_t(int64_t(y1) - y0 + 1);
  encoded.check_size(width, height);
  constexpr uint64_t most_channels = 4;
  check_memory(width, height, most_channels * sizeof(float), encoded.bytes.size(), encoded.name);
  const auto check_buffer = [&](uint64_t pixels) {
    if (pixels > max_buffer_bytes / std::max<uint64_t>(*part.bytes_per_pixel, 1))
      encoded.fail("EXR needs buffers beyond the limit");
  };
  const uint64_t lines = lines_per_chunk(*part.compression);
  check_buffer(width * lines);
  uint64_t chunks = (height + lines - 1) / lines;
  if (part.tile_size) {
    const auto [tile_x, tile_y] = *part.tile_size;
    if (tile_x == 0 || tile_y == 0 || tile_x > max_buffer_bytes || tile_y > max_buffer_bytes)
      encoded.fail("EXR with a bad tile size");
    const uint64_t across = (width + tile_x - 1) / tile_x;
    check_buffer(across * tile_x);           // prevents overflow below
    check_buffer(across * tile_x * tile_y);  // OpenEXR buffers a row of tiles
    const uint64_t tiles = across * ((height + tile_y - 1) / tile_y);
    // A file states twice whether it is tiled. If the statements differ, take the smaller count.
    chunks = is_tiled_file || part.type == "tiledimage" ? tiles : std::min(chunks, tiles);
  }
  // The table has 8 bytes per chunk, and each chunk stores at least its position and its size.
  if (chunks > encoded.bytes.size() / 8) encoded.fail("truncated EXR");
}

}  // namespace

void check_exr_header(const EncodedImage& encoded) {
  HeaderScanner scanner(encoded);
  scanner.take(4);
  const uint32_t version = scanner.u32();
  if ((version & 0xff) != 2) encoded.fail("EXR of an unknown version");
  if ((version & deep_flag) != 0) encoded.fail("EXR with deep data is not supported");
  const bool is_multipart = (version & multipart_flag) != 0;
  do {
    const std::string_view name = scanner.name();
    if (name.empty()) break;
    check_part(encoded, read_part(encoded, scanner, name), (version & tiled_flag) != 0);
  } while (is_multipart);
}

}  // namespace troffer
