#include "daylight/reinhart_sky.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "light/sky_light.h"

namespace troffer {

namespace {

constexpr std::array<int, 7> patches_of_rows{30, 30, 24, 24, 18, 12, 6};  // [1]

}  // namespace

Vec3d ReinhartPatch::direction(double u, double v) const {
  const double azimuth = left + (right - left) * u;
  const double up = low_sine + (high_sine - low_sine) * v;
  const double along = std::sqrt(std::max(0.0, 1 - up * up));
  return {along * std::sin(azimuth), along * std::cos(azimuth), up};
}

Vec3d ReinhartPatch::centre() const {
  if (right - left > pi) return {0, 0, 1};
  const double azimuth = (left + right) / 2, altitude = (low + high) / 2;
  return {std::cos(altitude) * std::sin(azimuth), std::cos(altitude) * std::cos(azimuth),
          std::sin(altitude)};
}

ReinhartSky::ReinhartSky(int subdivision) : strata_per_side_(size_t(std::max(1, 4 / subdivision))) {
  const int rows = int(patches_of_rows.size()) * subdivision;
  step_ = pi / 2 / (rows + 0.5);
  const auto add = [&](double low, double high, double left, double right) {
    ReinhartPatch p{low, high, left, right, std::sin(low), std::sin(high), 0, 0};
    p.solid_angle = (right - left) * (p.high_sine - p.low_sine);
    p.cosine = (right - left) / 2 * (sqr(p.high_sine) - sqr(p.low_sine));
    patches_.push_back(p);
  };
  for (int row = 0; row < rows; ++row) {
    const int count = patches_of_rows[size_t(row / subdivision)] * subdivision;
    rows_.push_back({patches_.size(), size_t(count)});
    const double width = 2 * pi / count;
    for (int i = 0; i < count; ++i)
      add(step_ * row, step_ * (row + 1), width * (i - 0.5), width * (i + 0.5));
  }
  rows_.push_back({patches_.size(), 1});
  add(step_ * rows, pi / 2, 0, 2 * pi);
}

size_t ReinhartSky::at(const Vec3d& d) const {
  const double altitude = std::asin(std::clamp(d.z, 0.0, 1.0));
  const size_t row = std::min(size_t(altitude / step_), rows_.size() - 1);
  const PatchRow& r = rows_[row];
  const double turns = std::atan2(d.x, d.y) / (2 * pi) + 1;  // above 0
  return r.first + size_t(turns * double(r.count) + 0.5) % r.count;
}

void patch_luminances(const ReinhartSky& sky, const SkyShape& shape, const Vec3d& to_sun,
                      double diffuse_lx, int samples, std::span<float> out) {
  double horizontal = 0;
  const double cells = double(samples) * samples;
  for (size_t i = 0; i < sky.size(); ++i) {
    const ReinhartPatch& p = sky.patches()[i];
    float sum = 0;
    for (int y = 0; y < samples; ++y)
      for (int x = 0; x < samples; ++x) {
        const Vec3d w =
            samples == 1 ? p.centre() : p.direction((x + 0.5) / samples, (y + 0.5) / samples);
        sum += relative_luminance(shape, float(w.z), float(dot(w, to_sun)));
      }
    out[i] = sum / float(cells);
    horizontal += double(out[i]) * p.cosine;
  }
  if (horizontal > 0) {
    for (float& l : out) l *= float(diffuse_lx / horizontal);
  } else {
    std::fill(out.begin(), out.end(), float(diffuse_lx / pi));  // outside the measured range
  }
}

}  // namespace troffer
