#include "import/environment_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/float_size.h"
#include "image/raster.h"
#include "import/file.h"
#include "scene/environment_lookup.h"

namespace troffer {

namespace {

constexpr size_t max_environment_texels = size_t(1) << 23;  // 4096 × 2048
constexpr uint64_t max_environment_bytes = uint64_t(1) << 31;
constexpr float largest_half = 65504;

struct Cleaned {
  size_t bad = 0, infinite = 0;
};

float clean(float value, float largest, Cleaned& count) {
  if (value == std::numeric_limits<float>::infinity()) {
    ++count.infinite;
    return largest;
  }
  if (value >= 0 && value <= 1e30f) return value;
  ++count.bad;
  return value > 0 && std::isfinite(value) ? 1e30f : 0.0f;
}

std::vector<Rgb> texels_of(const Raster& raster, Cleaned& count) {
  const auto channels = size_t(raster.channels);
  const std::vector<float>& values = raster.texels_float;
  float largest = largest_half;
  for (const float v : values)
    if (std::isfinite(v)) largest = std::max(largest, std::min(v, 1e30f));
  std::vector<Rgb> texels(size_t(raster.width) * size_t(raster.height));
  for (size_t i = 0; i < texels.size(); ++i) {
    const float* at = values.data() + i * channels;
    const float r = clean(at[0], largest, count);
    texels[i] =
        channels < 3 ? Rgb{r} : Rgb{r, clean(at[1], largest, count), clean(at[2], largest, count)};
  }
  return texels;
}

// Averages blocks of texels, which preserves energy.
EnvironmentMap reduced(const EnvironmentMap& from, int by) {
  EnvironmentMap to;
  to.name = from.name;
  to.projection = from.projection;
  to.width = std::max(1, from.width / by);
  to.height = std::max(1, from.height / by);
  to.texels.resize(size_t(to.width) * size_t(to.height));
  const auto first = [](int i, int n, int of) { return int(int64_t(i) * of / n); };
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      const int x0 = first(x, to.width, from.width), x1 = first(x + 1, to.width, from.width);
      const int y0 = first(y, to.height, from.height), y1 = first(y + 1, to.height, from.height);
      Rgb sum;
      for (int j = y0; j < y1; ++j)
        for (int i = x0; i < x1; ++i)
          sum += from.texels[size_t(j) * size_t(from.width) + size_t(i)];
      to.texels[size_t(y) * size_t(to.width) + size_t(x)] = sum / (float(x1 - x0) * float(y1 - y0));
    }
  return to;
}

}  // namespace

EnvironmentMap read_environment(const std::string& path, WarningLog& warnings) {
  const std::vector<uint8_t> bytes = read_file(path, max_environment_bytes);
  Raster read = decode_raster(bytes, path);
  check_float_size(read, bytes.size(), path);
  if (convert_to_srgb(read) == ColoursFound::broken) warnings.add(path + broken_colours);
  const Raster raster = rec709_raster(linear_raster(std::move(read)), false);
  EnvironmentMap map;
  map.name = path;
  map.width = raster.width;
  map.height = raster.height;
  map.projection = raster.width == raster.height ? SphereMap::equal_area : SphereMap::lat_long;
  Cleaned count;
  map.texels = texels_of(raster, count);
  if (count.bad > 0)
    warnings.add(
        fmt::format("{}: {} values are negative, not numbers or above 1e30", path, count.bad));
  if (count.infinite > 0)
    warnings.add(fmt::format(
        "{}: {} values are infinite; the image's largest value, or 65504, replaces them", path,
        count.infinite));
  if (map.projection == SphereMap::lat_long && map.width != 2 * map.height)
    warnings.add(
        fmt::format("{}: {} x {} is neither square (equal-area) nor twice as wide as high "
                    "(latitude-longitude); read as the latter",
                    path, map.width, map.height));
  if (map.texels.size() <= max_environment_texels) return map;
  int by = 2;
  while (map.texels.size() / (size_t(by) * size_t(by)) > max_environment_texels) ++by;
  warnings.add(
      fmt::format("{}: {} x {} texels are averaged down by {}", path, map.width, map.height, by));
  return reduced(map, by);
}

Rgb irradiance_from_above(const EnvironmentMap& map) {
  // Subdivide the texels of small images, because the cosine varies within them.
  constexpr int least_rows = 256;
  const int parts = (least_rows + map.height - 1) / map.height;
  const int columns = map.width * parts, rows = map.height * parts;
  double r = 0, g = 0, b = 0;
  for (int y = 0; y < rows; ++y) {
    const float v = (float(y) + 0.5f) / float(rows);
    for (int x = 0; x < columns; ++x) {
      const Vec2 uv{(float(x) + 0.5f) / float(columns), v};
      const Vec3 w = direction_from_square(map.projection, uv);
      if (!(w.z > 0)) continue;
      const double weight = double(w.z * solid_angle_per_area(map.projection, v));
      const Rgb texel = value_at(map, uv);
      r += weight * double(texel.r);
      g += weight * double(texel.g);
      b += weight * double(texel.b);
    }
  }
  const double n = double(columns) * double(rows);
  return {float(r / n), float(g / n), float(b / n)};
}

}  // namespace troffer
