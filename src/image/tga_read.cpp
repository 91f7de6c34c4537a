// References: [1] Truevision, "TGA File Format Specification", version 2.0, 1991.
#include <algorithm>
#include <array>

#include "image/decode.h"

namespace troffer {

namespace {

constexpr size_t header_size = 18;
enum Kind : uint8_t { kind_mapped = 1, kind_colour = 2, kind_grey = 3, run_length_bit = 8 };

struct Header {
  size_t id_bytes = 0, map_first = 0, map_length = 0;
  uint8_t map_type = 0, kind = 0, map_depth = 0, depth = 0, descriptor = 0;
  size_t width = 0, height = 0;

  uint8_t plain_kind() const { return kind & 7; }
  bool is_run_length() const { return (kind & run_length_bit) != 0; }
  int alpha_bits() const { return descriptor & 15; }
};

size_t word_at(std::span<const uint8_t> b, size_t at) {
  return size_t(b[at]) | size_t(b[at + 1]) << 8;
}

Header header_of(std::span<const uint8_t> b) {
  Header h;
  h.id_bytes = b[0];
  h.map_type = b[1];
  h.kind = b[2];
  h.map_first = word_at(b, 3);
  h.map_length = word_at(b, 5);
  h.map_depth = b[7];
  h.width = word_at(b, 12);
  h.height = word_at(b, 14);
  h.depth = b[16];
  h.descriptor = b[17];
  return h;
}

bool is_colour_depth(uint8_t depth) {
  return depth == 15 || depth == 16 || depth == 24 || depth == 32;
}

// Converts one colour as stored, 1 to 4 bytes in little-endian order, to r g b a.
std::array<uint8_t, 4> rgba_of(const uint8_t* at, int depth) {
  const auto widen = [](int five_bits) { return uint8_t((five_bits * 255 + 15) / 31); };
  if (depth == 8) return {at[0], at[0], at[0], 255};
  if (depth <= 16) {
    const int v = at[0] | at[1] << 8;
    return {widen(v >> 10 & 31), widen(v >> 5 & 31), widen(v & 31),
            uint8_t((v >> 15) != 0 ? 255 : 0)};
  }
  return {at[2], at[1], at[0], depth == 32 ? at[3] : uint8_t(255)};
}

class Reader {
 public:
  Reader(const EncodedImage& encoded, const Header& h)
      : encoded_(encoded),
        h_(h),
        at_(header_size + h.id_bytes),
        bytes_((size_t(h.depth) + 7) / 8) {}

  Raster read() {
    read_map();
    check_length();
    const bool is_grey = h_.plain_kind() == kind_grey;
    const int depth = h_.plain_kind() == kind_mapped ? h_.map_depth : h_.depth;
    // A fourth byte that the header does not declare as alpha is padding [1], Field 5.6.
    const bool has_alpha = !is_grey && depth >= 16 && h_.alpha_bits() > 0;
    Raster raster;
    raster.width = int(h_.width);
    raster.height = int(h_.height);
    raster.channels = is_grey ? 1 : has_alpha ? 4 : 3;
    raster.is_srgb = true;
    raster.texels8.resize(h_.width * h_.height * size_t(raster.channels));
    read_texels(raster);
    return raster;
  }

 private:
  const uint8_t* take(size_t n) {
    if (n > encoded_.bytes.size() - std::min(at_, encoded_.bytes.size()))
      encoded_.fail("broken TGA: the file ends early");
    at_ += n;
    return encoded_.bytes.data() + at_ - n;
  }

  void read_map() {
    if (h_.map_type == 0) return;
    const size_t bytes = (size_t(h_.map_depth) + 7) / 8;
    const uint8_t* entries = take(h_.map_length * bytes);
    if (h_.plain_kind() != kind_mapped) return;
    for (size_t i = 0; i < h_.map_length; ++i)
      map_.push_back(rgba_of(entries + i * bytes, h_.map_depth));
  }

  // Checks the file's length before memory is allocated. A run-length packet covers 128 texels at
  // most.
  void check_length() const {
    const size_t texels = h_.width * h_.height;
    const size_t least = h_.is_run_length() ? texels / 128 * (1 + bytes_) : texels * bytes_;
    if (least > encoded_.bytes.size() - std::min(at_, encoded_.bytes.size()))
      encoded_.fail("broken TGA: the file ends early");
  }

  std::array<uint8_t, 4> next_texel() {
    const uint8_t* const at = take(bytes_);
    if (h_.plain_kind() != kind_mapped)
      return rgba_of(at, h_.plain_kind() == kind_grey ? 8 : h_.depth);
    const size_t index = bytes_ == 1 ? at[0] : word_at({at, 2}, 0);
    if (index < h_.map_first || index - h_.map_first >= map_.size())
      encoded_.fail("broken TGA: a texel's index lies outside the colour map");
    return map_[index - h_.map_first];
  }

  void read_texels(Raster& raster) {
    size_t run = 0;  // texels left in the packet
    bool is_repeated = false;
    std::array<uint8_t, 4> texel{};
    for (size_t row = 0; row < h_.height; ++row)
      for (size_t column = 0; column < h_.width; ++column) {
        if (h_.is_run_length() && run == 0) {
          const uint8_t packet = *take(1);
          run = size_t(packet & 127) + 1;
          is_repeated = (packet & 128) != 0;
          if (is_repeated) texel = next_texel();
        }
        if (!is_repeated) texel = next_texel();
        if (run > 0) --run;
        put(raster, row, column, texel);
      }
  }

  // Descriptor bit 5: rows run from the top; bit 4: columns run from right to left.
  void put(Raster& raster, size_t row, size_t column, const std::array<uint8_t, 4>& texel) const {
    const auto channels = size_t(raster.channels);
    const size_t y = (h_.descriptor & 32) != 0 ? row : h_.height - 1 - row;
    const size_t x = (h_.descriptor & 16) != 0 ? h_.width - 1 - column : column;
    for (size_t c = 0; c < channels; ++c)
      raster.texels8[(y * h_.width + x) * channels + c] = texel[c];
  }

  const EncodedImage& encoded_;
  const Header& h_;
  size_t at_, bytes_;
  std::vector<std::array<uint8_t, 4>> map_;
};

}  // namespace

// The format has no magic number, so this accepts any plausible header.
bool is_tga(std::span<const uint8_t> bytes) {
  if (bytes.size() < header_size) return false;
  const Header h = header_of(bytes);
  if ((h.kind & ~(7 | run_length_bit)) != 0 || h.map_type > 1) return false;
  if (h.width == 0 || h.height == 0 || (h.descriptor & 0xc0) != 0) return false;
  switch (h.plain_kind()) {
    case kind_mapped:
      return h.map_type == 1 && is_colour_depth(h.map_depth) && (h.depth == 8 || h.depth == 16);
    case kind_colour:
      return is_colour_depth(h.depth) && (h.map_type == 0 || is_colour_depth(h.map_depth));
    case kind_grey:
      return h.depth == 8 && h.map_type == 0;
    default:
      return false;
  }
}

Raster decode_tga(const EncodedImage& encoded) {
  const Header h = header_of(encoded.bytes);
  encoded.check_size(h.width, h.height);
  return Reader(encoded, h).read();
}

}  // namespace troffer
