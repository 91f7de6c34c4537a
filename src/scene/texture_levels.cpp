// Levels of images: each is half as large as the one before, with the exact mean of the covered
// texels.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/texture.h"

namespace troffer {

namespace {

constexpr int largest_float_side = 32;

struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> texels;
};

// Texels of a source row that one output texel covers, and their weights: two, or up to three if
// the source size is odd.
struct Span {
  int first = 0, count = 0;
  std::array<float, 4> weights{};
};

std::vector<Span> spans(int from, int to) {
  std::vector<Span> all(static_cast<size_t>(to));
  const double step = double(from) / to;
  for (int i = 0; i < to; ++i) {
    const double low = i * step, high = (i + 1) * step;
    Span& s = all[size_t(i)];
    s.first = int(low);
    for (int k = s.first; k < from && s.count < 4; ++k) {
      const double covered = std::min(high, double(k + 1)) - std::max(low, double(k));
      if (covered < 1e-6) break;
      s.weights[size_t(s.count++)] = float(covered / step);
    }
  }
  return all;
}

// Requires that read(texel, channel) returns linear values.
template <class Read>
FloatImage halved(int width, int height, size_t channels, const Read& read) {
  FloatImage small;
  small.width = std::max(1, width / 2);
  small.height = std::max(1, height / 2);
  small.texels.assign(size_t(small.width) * size_t(small.height) * channels, 0);
  const std::vector<Span> columns = spans(width, small.width), rows = spans(height, small.height);
  float* out = small.texels.data();
  for (const Span& row : rows)
    for (const Span& column : columns) {
      if (row.count == 2 && column.count == 2) {  // the case of even sizes
        const float weight = row.weights[0] * column.weights[0];
        const size_t above = size_t(row.first) * size_t(width) + size_t(column.first);
        const size_t below = above + size_t(width);
        for (size_t c = 0; c < channels; ++c)
          out[c] = weight * read(above, c) + weight * read(above + 1, c) + weight * read(below, c) +
                   weight * read(below + 1, c);
        out += channels;
        continue;
      }
      for (int j = 0; j < row.count; ++j)
        for (int i = 0; i < column.count; ++i) {
          const float weight = row.weights[size_t(j)] * column.weights[size_t(i)];
          const size_t texel = size_t(row.first + j) * size_t(width) + size_t(column.first + i);
          for (size_t c = 0; c < channels; ++c) out[c] += weight * read(texel, c);
        }
      out += channels;
    }
  return small;
}

// Linear values of an image's bytes, and the inverse.
struct ByteCode {
  std::array<float, 256> values{};
  std::array<float, 255> ends{};  // midpoints between neighbouring values
  static constexpr size_t table_size = 1 << 12;
  std::array<uint8_t, table_size> starts{};  // first midpoint above that value, or one before
  bool is_srgb;

  explicit ByteCode(bool is_of_srgb) : is_srgb(is_of_srgb) {
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = is_srgb ? linear_from_srgb(float(i) / 255.0f) : float(i) / 255.0f;
    for (size_t i = 0; i + 1 < values.size(); ++i) ends[i] = 0.5f * (values[i] + values[i + 1]);
    for (size_t k = 0; k < table_size; ++k) {
      const float least = (float(k) - 0.5f) / (table_size - 1);
      starts[k] = uint8_t(std::upper_bound(ends.begin(), ends.end(), least) - ends.begin());
    }
  }
  // The table gives the start; only the darkest midpoints are closer together than its steps.
  uint8_t nearest(float value) const {
    size_t i = starts[size_t(std::clamp(value, 0.0f, 1.0f) * (table_size - 1))];
    while (i < ends.size() && ends[i] <= value) ++i;
    return uint8_t(i);
  }
};

}  // namespace

void build_levels(Texture& t) {
  t.levels.clear();
  t.levels8.clear();
  t.levels_float.clear();
  if (t.kind != TextureKind::image || (t.width <= 1 && t.height <= 1)) return;
  const auto n = size_t(t.channels);
  const size_t alpha = n == 2 ? 1 : n == 4 ? 3 : n;  // not sRGB-encoded; n if there is none
  const ByteCode color(t.is_srgb), plain(false);
  const auto code = [&](size_t c) -> const ByteCode& { return c == alpha ? plain : color; };
  std::array<const std::array<float, 256>*, 4> tables{};
  for (size_t c = 0; c < n; ++c) tables[c] = &code(c).values;
  const bool is_bytes = !t.texels8.empty();
  FloatImage at;
  for (int level = 0; level == 0 || at.width > 1 || at.height > 1; ++level) {
    if (level > 0)
      at = halved(at.width, at.height, n, [&](size_t i, size_t c) { return at.texels[i * n + c]; });
    else if (is_bytes)
      at = halved(t.width, t.height, n, [&, texels = t.texels8.data()](size_t i, size_t c) {
        return (*tables[c])[texels[i * n + c]];
      });
    else
      at = halved(t.width, t.height, n,
                  [&](size_t i, size_t c) { return t.texels_float[i * n + c]; });
    TextureLevel& l = t.levels.emplace_back();
    l.width = at.width;
    l.height = at.height;
    l.is_float = !is_bytes || std::max(at.width, at.height) <= largest_float_side;
    l.first = l.is_float ? t.levels_float.size() : t.levels8.size();
    if (l.is_float)
      t.levels_float.insert(t.levels_float.end(), at.texels.begin(), at.texels.end());
    else
      for (size_t i = 0; i < at.texels.size(); i += n)
        for (size_t c = 0; c < n; ++c) t.levels8.push_back(code(c).nearest(at.texels[i + c]));
  }
  t.levels8.shrink_to_fit();
  t.levels_float.shrink_to_fit();
}

}  // namespace troffer
