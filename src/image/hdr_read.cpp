// References: [1] Ward, "Radiance File Formats", "Picture File Format (.hdr)".
#include <algorithm>
#include <charconv>
#include <string_view>

#include "image/decode.h"
#include "image/float_size.h"
#include "image/rgbe.h"

namespace troffer {

namespace {

using Rgbe = std::array<uint8_t, 4>;

struct HdrReader {
  const EncodedImage& encoded;
  size_t at = 0;
  float exposure = 1;
  bool is_xyz = false;
  // Storage order of scan lines: row or column, rising or falling.
  bool is_column_major = false, is_x_falling = false, is_y_falling = false;
  size_t width = 0, height = 0;

  size_t left() const { return encoded.bytes.size() - at; }
  uint8_t byte() {
    if (left() == 0) encoded.fail("truncated HDR");
    return encoded.bytes[at++];
  }
  std::string_view line() {
    const auto rest = encoded.bytes.subspan(at);
    const auto end = std::find(rest.begin(), rest.end(), uint8_t('\n'));
    if (end == rest.end()) encoded.fail("truncated HDR header");
    const auto n = size_t(end - rest.begin());
    at += n + 1;
    return {reinterpret_cast<const char*>(rest.data()), n};
  }
};

// Reads "EXPOSURE=" and "FORMAT=" up to the empty line [1]. Several exposures are multiplied.
void read_header(HdrReader& reader) {
  reader.line();  // "#?RADIANCE"
  for (std::string_view line = reader.line(); !line.empty() && line != "\r"; line = reader.line()) {
    if (line.starts_with("EXPOSURE=")) {
      line.remove_prefix(9);
      while (line.starts_with(' ')) line.remove_prefix(1);
      float value = 0;
      std::from_chars(line.data(), line.data() + line.size(), value);
      if (!(value > 0 && value < 1e30f)) reader.encoded.fail("HDR header: bad EXPOSURE");
      reader.exposure *= value;
    } else if (line.starts_with("FORMAT=")) {
      if (line.find("32-bit_rle_xyze") != line.npos)
        reader.is_xyz = true;
      else if (line.find("32-bit_rle_rgbe") == line.npos)
        reader.encoded.fail("HDR header: unsupported " + std::string(line));
    }
  }
  if (!(reader.exposure > 1e-30f && reader.exposure < 1e30f))
    reader.encoded.fail("HDR header: bad EXPOSURE");
}

// Reads "-Y 480 +X 640" or one of its seven variants: the first axis is the slow one [1].
void read_resolution(HdrReader& reader) {
  std::string_view line = reader.line();
  const auto bad = [&]() { reader.encoded.fail("HDR: bad resolution line"); };
  for (int axis = 0; axis < 2; ++axis) {
    while (line.starts_with(' ')) line.remove_prefix(1);
    if (line.size() < 3 || (line[0] != '-' && line[0] != '+')) bad();
    const bool is_falling = line[0] == '-', is_x = line[1] == 'X';
    if (!is_x && line[1] != 'Y') bad();
    line.remove_prefix(2);
    while (line.starts_with(' ')) line.remove_prefix(1);
    uint32_t n = 0;
    const auto result = std::from_chars(line.data(), line.data() + line.size(), n);
    if (result.ec != std::errc()) bad();
    line.remove_prefix(size_t(result.ptr - line.data()));
    if (axis == 0) reader.is_column_major = is_x;
    (is_x ? reader.width : reader.height) = n;
    (is_x ? reader.is_x_falling : reader.is_y_falling) = is_falling;
  }
  const EncodedImage& encoded = reader.encoded;
  encoded.check_size(reader.width, reader.height);
  check_memory(reader.width, reader.height, 3 * sizeof(float), encoded.bytes.size(), encoded.name);
}

// Reads a scan line whose four components are stored separately, with runs of up to 127 equal bytes
// [1].
void read_new_line(HdrReader& reader, std::vector<Rgbe>& line) {
  for (size_t c = 0; c < 4; ++c)
    for (size_t x = 0; x < line.size();) {
      size_t n = reader.byte();
      const bool is_run = n > 128;
      if (is_run) n -= 128;
      if (n == 0 || n > line.size() - x) reader.encoded.fail("broken HDR: run beyond its line");
      const uint8_t value = is_run ? reader.byte() : uint8_t(0);
      for (size_t end = x + n; x < end; ++x) line[x][c] = is_run ? value : reader.byte();
    }
}

// Reads plain pixels. (1,1,1,n) repeats the last pixel n times; consecutive counts are digits of
// increasing weight [1].
void read_old_line(HdrReader& reader, std::vector<Rgbe>& line) {
  unsigned shift = 0;
  for (size_t x = 0; x < line.size();) {
    Rgbe p{};
    for (uint8_t& v : p) v = reader.byte();
    if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
      const size_t n = shift < 32 ? size_t(p[3]) << shift : 0;
      if (n > line.size() - x || x == 0 || shift >= 32)
        reader.encoded.fail("broken HDR: run beyond its line");
      std::fill_n(line.begin() + std::ptrdiff_t(x), n, line[x - 1]);
      x += n;
      shift += 8;
    } else {
      line[x++] = p;
      shift = 0;
    }
  }
}

void read_line(HdrReader& reader, std::vector<Rgbe>& line) {
  const size_t n = line.size();
  const auto rest = reader.encoded.bytes.subspan(reader.at);
  const bool is_new =
      n >= 8 && n <= 0x7fff && rest.size() >= 4 && rest[0] == 2 && rest[1] == 2 && rest[2] < 128;
  if (!is_new) return read_old_line(reader, line);
  if (size_t(rest[2]) * 256 + rest[3] != n) reader.encoded.fail("broken HDR: bad line length");
  reader.at += 4;
  read_new_line(reader, line);
}

// Converts CIE XYZ with white D65 to linear Rec. 709 (IEC 61966-2-1).
Rgb rgb_from_xyz(Rgb c) {
  return {3.2406255f * c.r - 1.5372080f * c.g - 0.4986286f * c.b,
          -0.9689307f * c.r + 1.8757561f * c.g + 0.0415175f * c.b,
          0.0557101f * c.r - 0.2040211f * c.g + 1.0569959f * c.b};
}

}  // namespace

bool is_hdr(std::span<const uint8_t> bytes) {
  return bytes.size() >= 2 && bytes[0] == '#' && bytes[1] == '?';
}

Raster decode_hdr(const EncodedImage& encoded) {
  HdrReader reader{encoded};
  read_header(reader);
  read_resolution(reader);
  const size_t lines = reader.is_column_major ? reader.width : reader.height;
  const size_t length = reader.is_column_major ? reader.height : reader.width;
  // The shortest scan line is one pixel.
  if (reader.left() / 4 < lines) encoded.fail("truncated HDR");

  Raster raster;
  raster.width = int(reader.width);
  raster.height = int(reader.height);
  raster.channels = 3;
  raster.texels_float.resize(reader.width * reader.height * 3);
  std::vector<Rgbe> line(length);
  for (size_t j = 0; j < lines; ++j) {
    read_line(reader, line);
    for (size_t i = 0; i < length; ++i) {
      size_t x = reader.is_column_major ? j : i, y = reader.is_column_major ? i : j;
      if (reader.is_x_falling) x = reader.width - 1 - x;
      if (!reader.is_y_falling) y = reader.height - 1 - y;  // Y points up
      Rgb c = rgb_from_rgbe(line[i]) / reader.exposure;
      if (reader.is_xyz) c = rgb_from_xyz(c);
      std::copy_n(&c.r, 3, raster.texels_float.data() + (y * reader.width + x) * 3);
    }
  }
  return raster;
}

}  // namespace troffer
