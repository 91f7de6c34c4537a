// Windows bitmaps.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "image/raster.h"

using namespace troffer;

namespace {

using BmpBytes = std::vector<uint8_t>;

void put_number(BmpBytes& to, uint32_t value, size_t bytes) {
  for (size_t i = 0; i < bytes; ++i) to.push_back(uint8_t(value >> (8 * i)));
}

struct Bmp {
  int width = 2, height = 2, depth = 24;
  uint32_t compression = 0;
  BmpBytes map{}, body{};  // masks and palette; texels

  BmpBytes bytes() const {
    BmpBytes out{'B', 'M'};
    put_number(out, 0, 8);
    put_number(out, uint32_t(54 + map.size()), 4);
    put_number(out, 40, 4);
    put_number(out, uint32_t(width), 4);
    put_number(out, uint32_t(height), 4);
    put_number(out, 1, 2);
    put_number(out, uint32_t(depth), 2);
    put_number(out, compression, 4);
    put_number(out, 0, 3 * 4);
    put_number(out, depth <= 8 ? uint32_t(map.size() / 4) : 0, 4);  // number of colours
    put_number(out, 0, 4);
    out.insert(out.end(), map.begin(), map.end());
    out.insert(out.end(), body.begin(), body.end());
    return out;
  }
};

std::string why_bmp_is_rejected(const BmpBytes& bytes) {
  try {
    decode_raster(bytes, "file");
  } catch (const InputError& e) {
    return e.reason();
  }
  return "";
}

const BmpBytes bmp_colours{1, 2, 3, 0, 4, 5, 6, 0};  // blue green red, padding

}  // namespace

TEST_CASE("BMP: rows from bottom and from top, padded to whole words") {
  Bmp b{.body = {1, 2, 3, 4, 5, 6, 0, 0, 7, 8, 9, 10, 11, 12, 0, 0}};
  const Raster r = decode_raster(b.bytes(), "file");
  CHECK(r.channels == 3);
  CHECK(r.is_srgb);
  CHECK(r.texels8 == BmpBytes{9, 8, 7, 12, 11, 10, 3, 2, 1, 6, 5, 4});
  b.height = -2;
  CHECK(decode_raster(b.bytes(), "file").texels8 ==
        BmpBytes{3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10});
}

TEST_CASE("BMP: palettes of 1, 4 and 8 bits") {
  Bmp b{.height = 1, .depth = 1, .map = bmp_colours, .body = {0x40, 0, 0, 0}};
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{3, 2, 1, 6, 5, 4});
  b.depth = 4;
  b.body = {0x10, 0, 0, 0};
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{6, 5, 4, 3, 2, 1});
  b.depth = 8;
  b.body = {1, 1, 0, 0};
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{6, 5, 4, 6, 5, 4});
}

TEST_CASE("BMP: 16 and 32 bits, with and without fields") {
  Bmp b{
      .width = 1, .height = 1, .depth = 16, .body = {0x1f, 0x7c, 0, 0}};  // red and blue of 5 bits
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{255, 0, 255});
  b.depth = 32;
  b.body = {1, 2, 3, 9};
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{3, 2, 1});
  b.compression = 6;  // red in the lowest byte, alpha in the highest
  put_number(b.map, 0xff, 4);
  put_number(b.map, 0xff00, 4);
  put_number(b.map, 0xff0000, 4);
  put_number(b.map, 0xff000000, 4);
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{1, 2, 3, 9});
}

TEST_CASE("BMP: run lengths of 8 and 4 bits") {
  Bmp b{.width = 3, .height = 2, .depth = 8, .compression = 1, .map = bmp_colours};
  // Below: two of colour 1, the rest of the row 0. Above: three literal colours, padded.
  b.body = {2, 1, 0, 0, 0, 3, 0, 1, 0, 0, 0, 1};
  CHECK(decode_raster(b.bytes(), "file").texels8 ==
        BmpBytes{3, 2, 1, 6, 5, 4, 3, 2, 1, 6, 5, 4, 6, 5, 4, 3, 2, 1});
  b.depth = 4;
  b.compression = 2;
  b.height = 1;
  b.body = {3, 0x10, 0, 1};
  CHECK(decode_raster(b.bytes(), "file").texels8 == BmpBytes{6, 5, 4, 3, 2, 1, 6, 5, 4});
}

TEST_CASE("BMP: broken files are refused before memory is taken") {
  Bmp b{.body = {1, 2, 3, 4, 5, 6, 0, 0, 7, 8, 9, 10, 11}};
  CHECK(why_bmp_is_rejected(b.bytes()).find("ends early") != std::string::npos);
  b.width = b.height = 20000;
  CHECK_FALSE(why_bmp_is_rejected(b.bytes()).empty());
  b = {.depth = 13};
  CHECK(why_bmp_is_rejected(b.bytes()).find("not supported") != std::string::npos);
  const BmpBytes whole = Bmp{
      .width = 3,
      .height = 2,
      .depth = 8,
      .compression = 1,
      .map = bmp_colours,
      .body = {2, 1, 0, 0, 0, 3, 0, 1, 0, 0, 0,
               1}}.bytes();
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    BmpBytes changed = whole;
    for (int k = 0; k < 3; ++k)
      changed[size_t(random.next_float() * float(changed.size()))] =
          uint8_t(random.next_float() * 256);
    why_bmp_is_rejected(changed);  // must load or throw InputError
  }
}
