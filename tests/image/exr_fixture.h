// EXR files assembled byte by byte from the published layout, without OpenEXR.
// References: [1] "OpenEXR File Layout", openexr.com.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace troffer::test {

enum class ExrType : int32_t { uint = 0, half = 1, floating = 2 };

// Pixel (x, y), relative to the data window's corner, of channel c holds exr_value(c, x, y), or
// `constants[c]` if given. Values are integers below 2048, which every type represents exactly.
struct ExrFixture {
  std::vector<std::string> channels{"B", "G", "R"};  // in alphabetical order
  ExrType type = ExrType::floating;
  int width = 70, height = 50, x = 0, y = 0;
  int tile_width = 0, tile_height = 0;  // 0: scan lines
  bool is_decreasing = false;
  std::vector<float> constants;
  std::vector<int> sampling = {};  // per channel; empty: 1
  // x and y of red, green, blue and white; empty: no attribute
  std::vector<float> chromaticities = {};
};

inline float exr_value(size_t channel, int x, int y) {
  return float((int(channel) * 397 + x * 31 + y * 17) % 2048);
}

class ExrWriter {
 public:
  explicit ExrWriter(const ExrFixture& fixture) : f_(fixture) {}

  std::vector<uint8_t> file() {
    header();
    const bool is_tiled = f_.tile_width > 0;
    const int step_x = is_tiled ? f_.tile_width : f_.width, step_y = is_tiled ? f_.tile_height : 1;
    std::vector<std::pair<int, int>> corners;
    for (int y = 0; y < f_.height; y += step_y)
      for (int x = 0; x < f_.width; x += step_x) corners.emplace_back(x, y);
    const size_t table = out_.size();
    out_.resize(table + 8 * corners.size());
    std::vector<size_t> order;
    for (size_t i = 0; i < corners.size(); ++i) order.push_back(i);
    if (f_.is_decreasing) std::reverse(order.begin(), order.end());
    for (const size_t i : order) {
      const uint64_t at = out_.size();
      std::memcpy(out_.data() + table + 8 * i, &at, 8);
      const auto [x, y] = corners[i];
      if (is_tiled) {
        i32(x / step_x);
        i32(y / step_y);
        i32(0);
        i32(0);
      } else {
        i32(f_.y + y);
      }
      chunk(x, y, std::min(x + step_x, f_.width), std::min(y + step_y, f_.height));
    }
    return std::move(out_);
  }

 private:
  void i32(int32_t v) {
    const auto bits = uint32_t(v);
    for (int i = 0; i < 4; ++i) out_.push_back(uint8_t(bits >> (8 * i)));
  }
  void text(const std::string& s) {
    out_.insert(out_.end(), s.begin(), s.end());
    out_.push_back(0);
  }
  void attribute(const std::string& name, const std::string& type, int size) {
    text(name);
    text(type);
    i32(size);
  }
  int sampling(size_t c) const { return f_.sampling.empty() ? 1 : f_.sampling[c]; }

  void header() {
    i32(20000630);
    i32(f_.tile_width > 0 ? 0x202 : 2);
    int size = 1;
    for (const auto& name : f_.channels) size += int(name.size()) + 1 + 16;
    attribute("channels", "chlist", size);
    for (size_t c = 0; c < f_.channels.size(); ++c) {
      text(f_.channels[c]);
      i32(int32_t(f_.type));
      i32(0);
      i32(sampling(c));
      i32(sampling(c));
    }
    out_.push_back(0);
    if (!f_.chromaticities.empty()) attribute("chromaticities", "chromaticities", 32);
    for (const float v : f_.chromaticities) i32(std::bit_cast<int32_t>(v));
    attribute("compression", "compression", 1);
    out_.push_back(0);
    attribute("dataWindow", "box2i", 16);
    for (const int v : {f_.x, f_.y, f_.x + f_.width - 1, f_.y + f_.height - 1}) i32(v);
    attribute("displayWindow", "box2i", 16);
    for (const int v : {0, 0, 999, 999}) i32(v);
    attribute("lineOrder", "lineOrder", 1);
    out_.push_back(f_.is_decreasing ? 1 : 0);
    attribute("pixelAspectRatio", "float", 4);
    i32(std::bit_cast<int32_t>(1.0f));
    attribute("screenWindowCenter", "v2f", 8);
    i32(0);
    i32(0);
    attribute("screenWindowWidth", "float", 4);
    i32(std::bit_cast<int32_t>(1.0f));
    if (f_.tile_width > 0) {
      attribute("tiles", "tiledesc", 9);
      i32(f_.tile_width);
      i32(f_.tile_height);
      out_.push_back(0);
    }
    out_.push_back(0);
  }

  // Writes the size of a block of pixels, then its lines, channel by channel.
  void chunk(int x0, int y0, int x1, int y1) {
    const size_t size_at = out_.size();
    i32(0);
    for (int y = y0; y < y1; ++y)
      for (size_t c = 0; c < f_.channels.size(); ++c) {
        if (y % sampling(c) != 0) continue;
        for (int x = x0; x < x1; x += sampling(c))
          value(f_.constants.empty() ? exr_value(c, x, y) : f_.constants[c]);
      }
    const auto size = uint32_t(out_.size() - size_at - 4);
    std::memcpy(out_.data() + size_at, &size, 4);
  }

  void value(float v) {
    if (f_.type == ExrType::floating) return i32(std::bit_cast<int32_t>(v));
    if (f_.type == ExrType::uint) return i32(int32_t(v));
    int exponent = 0;  // half: v = 1.m * 2^e, e biased by 15; all values are exact and normal
    const float fraction = std::frexp(v, &exponent);
    const int bits = v == 0 ? 0 : ((exponent + 14) << 10) + int(fraction * 2048) - 1024;
    out_.push_back(uint8_t(bits));
    out_.push_back(uint8_t(bits >> 8));
  }

  const ExrFixture& f_;
  std::vector<uint8_t> out_;
};

inline std::vector<uint8_t> make_exr(const ExrFixture& fixture) {
  return ExrWriter(fixture).file();
}

}  // namespace troffer::test
