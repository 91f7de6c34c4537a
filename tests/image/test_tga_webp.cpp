// Truevision TGA and WebP.
#include <doctest/doctest.h>
#include <webp/encode.h>

#include <array>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "image/raster.h"

using namespace troffer;

namespace test_tga_webp {

namespace {

using Bytes = std::vector<uint8_t>;

struct Tga {
  int kind = 2, width = 2, height = 2, depth = 24, descriptor = 0;
  int map_first = 0, map_length = 0, map_depth = 0;
  Bytes body{};  // the map, then the texels

  Bytes bytes() const {
    const auto low = [](int v) { return uint8_t(v & 255); };
    Bytes out;
    out.reserve(21 + body.size());
    for (const int v : {3, map_length > 0 ? 1 : 0, kind}) out.push_back(low(v));
    for (const int v : {map_first, map_length}) out.insert(out.end(), {low(v), low(v >> 8)});
    out.insert(out.end(), {low(map_depth), 0, 0, 0, 0});
    for (const int v : {width, height}) out.insert(out.end(), {low(v), low(v >> 8)});
    out.insert(out.end(), {low(depth), low(descriptor), 'i', 'd', '!'});
    out.insert(out.end(), body.begin(), body.end());
    return out;
  }
};

std::string why_rejected(const Bytes& bytes) {
  try {
    decode_raster(bytes, "file");
  } catch (const InputError& e) {
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("TGA: colours from below, from above and mirrored") {
  // Blue, green, red; the file's first row is the lowest.
  Tga t{.body = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
  Raster r = decode_raster(t.bytes(), "file");
  CHECK(r.channels == 3);
  CHECK(r.is_srgb);
  CHECK(r.texels8 == Bytes{9, 8, 7, 12, 11, 10, 3, 2, 1, 6, 5, 4});
  t.descriptor = 32;
  CHECK(decode_raster(t.bytes(), "file").texels8 == Bytes{3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10});
  t.descriptor = 16;
  CHECK(decode_raster(t.bytes(), "file").texels8 == Bytes{12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1});
}

TEST_CASE("TGA: alpha where the header says so, 16 bits, grey, colour maps") {
  Tga t{.width = 1, .height = 1, .depth = 32, .descriptor = 8, .body = {1, 2, 3, 4}};
  CHECK(decode_raster(t.bytes(), "file").texels8 == Bytes{3, 2, 1, 4});
  t.descriptor = 0;  // the fourth byte is padding
  CHECK(decode_raster(t.bytes(), "file").texels8 == Bytes{3, 2, 1});
  const Tga few_bits{.width = 1, .height = 1, .depth = 16, .body = {0x1f, 0x7c}};
  CHECK(decode_raster(few_bits.bytes(), "file").texels8 == Bytes{255, 0, 255});
  const Tga grey{.kind = 3, .width = 2, .height = 1, .depth = 8, .body = {7, 200}};
  CHECK(decode_raster(grey.bytes(), "file").texels8 == Bytes{7, 200});
  Tga mapped{.kind = 1,
             .width = 2,
             .height = 1,
             .depth = 8,
             .map_first = 5,
             .map_length = 2,
             .map_depth = 24,
             .body = {1, 2, 3, 4, 5, 6, 6, 5}};
  CHECK(decode_raster(mapped.bytes(), "file").texels8 == Bytes{6, 5, 4, 3, 2, 1});
  mapped.body.back() = 4;
  CHECK(why_rejected(mapped.bytes()).find("map") != std::string::npos);
}

TEST_CASE("TGA: run lengths, also over the ends of rows") {
  const Tga t{.kind = 11,
              .width = 3,
              .height = 2,
              .depth = 8,
              .descriptor = 32,
              .body = {0x83, 9, 0x01, 1, 2}};  // four times 9, then 1 and 2
  CHECK(decode_raster(t.bytes(), "file").texels8 == Bytes{9, 9, 9, 9, 1, 2});
}

TEST_CASE("TGA: truncated files and false headers are errors before memory is taken") {
  Tga t{.kind = 10, .width = 2, .height = 2, .depth = 24, .body = {0x83, 1, 2, 3}};
  Bytes whole = t.bytes();
  CHECK(why_rejected(whole).empty());
  for (size_t n = 0; n < whole.size(); ++n)
    CHECK_FALSE(why_rejected({whole.begin(), whole.begin() + std::ptrdiff_t(n)}).empty());
  t.width = t.height = 65535;
  CHECK(why_rejected(t.bytes()).find("limit") != std::string::npos);
  t.width = t.height = 8000;
  CHECK(why_rejected(t.bytes()).find("ends early") != std::string::npos);
  Random random(5);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bad = whole;
    for (int k = 0; k < 3; ++k) bad[random.next_u32() % bad.size()] = uint8_t(random.next_u32());
    why_rejected(bad);
  }
}

TEST_CASE("WebP: without loss, with alpha; damaged files are errors or pictures") {
  const Bytes pixels{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 7, 255, 255, 255, 255};
  uint8_t* out = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(pixels.data(), 2, 2, 8, &out);
  REQUIRE(size > 0);
  const Bytes whole(out, out + size);
  WebPFree(out);
  const Raster raster = decode_raster(whole, "file");
  CHECK(raster.channels == 4);
  CHECK(raster.is_srgb);
  CHECK(raster.texels8 == pixels);
  for (size_t n = 1; n < whole.size(); ++n)
    CHECK_FALSE(why_rejected({whole.begin(), whole.begin() + std::ptrdiff_t(n)}).empty());
  Random random(6);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes bad = whole;
    bad[random.next_u32() % bad.size()] = uint8_t(random.next_u32());
    why_rejected(bad);
  }
}

}  // namespace test_tga_webp
