// References: [1] Microsoft, "Bitmap Storage" and "BITMAPINFOHEADER structure" (Windows GDI
//   documentation): headers, bit fields, run lengths.
#include <algorithm>
#include <array>
#include <bit>

#include "image/decode.h"

namespace troffer {

namespace {

constexpr size_t bmp_file_header = 14, bmp_core_header = 12, bmp_info_header = 40;
enum BmpCompression : uint32_t {
  bmp_plain = 0,
  bmp_rle8 = 1,
  bmp_rle4 = 2,
  bmp_bit_fields = 3,
  bmp_alpha_fields = 6
};

uint32_t bmp_number(std::span<const uint8_t> b, size_t at, size_t bytes) {
  uint32_t v = 0;
  for (size_t i = 0; i < bytes; ++i) v |= uint32_t(b[at + i]) << (8 * i);
  return v;
}

struct BmpHeader {
  size_t size = 0, pixels = 0;  // size of the second header; offset of the texels
  int64_t width = 0, height = 0;
  bool is_top_down = false;
  uint32_t depth = 0, compression = bmp_plain, colours = 0;
  std::array<uint32_t, 4> masks{};  // red, green, blue, alpha
};

// Returns a channel of 1 to 32 bits at any position in a number, as 8 bits.
uint8_t bmp_channel(uint32_t value, uint32_t mask) {
  if (mask == 0) return 0;
  const int shift = std::countr_zero(mask);
  const uint64_t largest = mask >> shift;
  return uint8_t((uint64_t((value & mask) >> shift) * 255 + largest / 2) / largest);
}

class BmpReader {
 public:
  explicit BmpReader(const EncodedImage& encoded) : encoded_(encoded), b_(encoded.bytes) {}

  Raster read() {
    read_header();
    encoded_.check_size(uint64_t(h_.width), uint64_t(h_.height));
    read_palette();
    raster_.width = int(h_.width);
    raster_.height = int(h_.height);
    raster_.channels = h_.masks[3] != 0 ? 4 : 3;
    raster_.is_srgb = true;
    if (h_.compression == bmp_rle8 || h_.compression == bmp_rle4) {
      allocate(b_.size() * 255);  // a pair of bytes encodes 255 texels at most
      read_runs();
    } else {
      allocate(b_.size() * 8);
      read_rows();
    }
    return std::move(raster_);
  }

 private:
  const EncodedImage& encoded_;
  std::span<const uint8_t> b_;
  BmpHeader h_;
  std::vector<std::array<uint8_t, 3>> palette_;
  Raster raster_;

  void need(size_t at, size_t bytes) const {
    if (at > b_.size() || bytes > b_.size() - at) encoded_.fail("broken BMP: the file ends early");
  }

  void read_header() {
    need(0, bmp_file_header + 4);
    h_.pixels = bmp_number(b_, 10, 4);
    h_.size = bmp_number(b_, bmp_file_header, 4);
    if (h_.size != bmp_core_header && h_.size < bmp_info_header)
      encoded_.fail("broken BMP: unknown header");
    need(bmp_file_header, h_.size);
    const size_t at = bmp_file_header + 4;
    if (h_.size == bmp_core_header) {
      h_.width = bmp_number(b_, at, 2);
      h_.height = bmp_number(b_, at + 2, 2);
      h_.depth = bmp_number(b_, at + 6, 2);
    } else {
      h_.width = int32_t(bmp_number(b_, at, 4));
      h_.height = int32_t(bmp_number(b_, at + 4, 4));
      h_.depth = bmp_number(b_, at + 10, 2);
      h_.compression = bmp_number(b_, at + 12, 4);
      h_.colours = bmp_number(b_, at + 28, 4);
    }
    h_.is_top_down = h_.height < 0;
    if (h_.is_top_down) h_.height = -h_.height;
    if (h_.width < 0) encoded_.fail("broken BMP: negative width");
    read_masks();
  }

  void read_masks() {
    const bool has_masks = h_.compression == bmp_bit_fields || h_.compression == bmp_alpha_fields;
    const bool is_fine = (h_.compression == bmp_plain && is_depth({1, 4, 8, 16, 24, 32})) ||
                         (h_.compression == bmp_rle8 && h_.depth == 8) ||
                         (h_.compression == bmp_rle4 && h_.depth == 4) ||
                         (has_masks && is_depth({16, 32}));
    if (!is_fine) encoded_.fail("BMP of a kind that is not supported");
    h_.masks = h_.depth == 16 ? std::array<uint32_t, 4>{0x7c00, 0x3e0, 0x1f, 0}
                              : std::array<uint32_t, 4>{0xff0000, 0xff00, 0xff, 0};
    if (!has_masks) return;
    const size_t at = bmp_file_header + bmp_info_header;
    const bool has_alpha = h_.compression == bmp_alpha_fields || h_.size >= bmp_info_header + 16;
    need(at, has_alpha ? 16 : 12);
    for (size_t k = 0; k < (has_alpha ? 4u : 3u); ++k) h_.masks[k] = bmp_number(b_, at + 4 * k, 4);
  }

  bool is_depth(std::initializer_list<uint32_t> known) const {
    return std::find(known.begin(), known.end(), h_.depth) != known.end();
  }

  void read_palette() {
    if (h_.depth > 8) return;
    const size_t entry = h_.size == bmp_core_header ? 3 : 4, all = size_t(1) << h_.depth;
    const size_t count = h_.colours == 0 ? all : std::min<size_t>(h_.colours, all);
    const size_t at = bmp_file_header + h_.size;
    need(at, count * entry);
    for (size_t i = 0; i < count; ++i) {
      const uint8_t* c = b_.data() + at + i * entry;
      palette_.push_back({c[2], c[1], c[0]});
    }
    palette_.resize(all);  // black
  }

  // Rejects files that are too short for their size before memory is allocated.
  void allocate(size_t most_texels) {
    const size_t texels = size_t(h_.width) * size_t(h_.height);
    if (texels > most_texels) encoded_.fail("broken BMP: the file ends early");
    raster_.texels8.resize(texels * size_t(raster_.channels));
  }

  uint8_t* texel(size_t x, size_t row) {
    const size_t y = h_.is_top_down ? row : size_t(h_.height) - 1 - row;
    return raster_.texels8.data() + (y * size_t(h_.width) + x) * size_t(raster_.channels);
  }

  void put_mapped(size_t x, size_t row, size_t index) {
    const std::array<uint8_t, 3>& c = palette_[std::min(index, palette_.size() - 1)];
    std::copy(c.begin(), c.end(), texel(x, row));
  }

  void read_rows() {
    const auto width = size_t(h_.width), height = size_t(h_.height);
    const size_t stride = (width * h_.depth + 31) / 32 * 4;
    need(h_.pixels, stride * (height - 1) + (width * h_.depth + 7) / 8);
    for (size_t row = 0; row < height; ++row) {
      const uint8_t* const line = b_.data() + h_.pixels + row * stride;
      for (size_t x = 0; x < width; ++x) {
        if (h_.depth <= 8) {
          const size_t bit = x * h_.depth, shift = 8 - h_.depth - bit % 8;
          put_mapped(x, row, size_t(line[bit / 8] >> shift) & ((size_t(1) << h_.depth) - 1));
          continue;
        }
        const size_t bytes = h_.depth / 8;
        const uint32_t v = bmp_number({line + x * bytes, bytes}, 0, bytes);
        uint8_t* const out = texel(x, row);
        for (size_t k = 0; k < size_t(raster_.channels); ++k) out[k] = bmp_channel(v, h_.masks[k]);
      }
    }
  }

  // Reads pairs of a count and a colour. A count of 0 ends a row or the picture, moves the
  // position, or starts literal colours, padded to an even number of bytes.
  void read_runs() {
    const auto width = size_t(h_.width), height = size_t(h_.height);
    for (size_t row = 0; row < height; ++row)
      for (size_t x = 0; x < width; ++x) put_mapped(x, row, 0);
    const auto put = [&](size_t x, size_t row, size_t index) {
      if (x < width && row < height) put_mapped(x, row, index);
    };
    const bool is_half = h_.compression == bmp_rle4;
    size_t at = h_.pixels, x = 0, row = 0;
    while (row < height) {
      need(at, 2);
      const size_t count = b_[at], value = b_[at + 1];
      at += 2;
      if (count > 0) {
        for (size_t i = 0; i < count; ++i)
          put(x++, row, !is_half ? value : i % 2 == 0 ? value >> 4 : value & 15);
      } else if (value == 0) {
        x = 0;
        ++row;
      } else if (value == 1) {
        return;
      } else if (value == 2) {
        need(at, 2);
        x += b_[at];
        row += b_[at + 1];
        at += 2;
      } else {
        const size_t bytes = is_half ? (value + 1) / 2 : value;
        need(at, bytes);
        for (size_t i = 0; i < value; ++i) {
          const size_t byte = b_[at + (is_half ? i / 2 : i)];
          put(x++, row, !is_half ? byte : i % 2 == 0 ? byte >> 4 : byte & 15);
        }
        at += bytes + bytes % 2;
      }
    }
  }
};

}  // namespace

bool is_bmp(std::span<const uint8_t> bytes) {
  return bytes.size() >= bmp_file_header + 4 && bytes[0] == 'B' && bytes[1] == 'M' &&
         bmp_number(bytes, bmp_file_header, 4) <= 256;
}

Raster decode_bmp(const EncodedImage& encoded) {
  return BmpReader(encoded).read();
}

}  // namespace troffer
