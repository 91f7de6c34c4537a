#include "compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "base/vec.h"
#include "compare/convolve.h"

namespace troffer {

namespace {

// Constants of [1]: colour and feature pipelines.
constexpr float q_c = 0.7f, p_c = 0.4f, p_t = 0.95f;  // compression of colour differences
constexpr float q_f = 0.5f;                           // exponent of feature differences
constexpr double feature_width_deg = 0.082;

// Contrast sensitivity of a channel as a sum of Gaussians in frequency, a exp(-b f^2) [1, colour
// pipeline: spatial filtering].
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1, 0.0047, 0, 1e-5};
constexpr Sensitivity red_green{1, 0.0053, 0, 1e-5};
constexpr Sensitivity blue_yellow{34.1, 0.04, 13.5, 0.025};
constexpr double widest_b = 0.04;

using Planes = std::array<PixelPlane, 3>;

// Converts linear Rec. 709 (white D65) to CIE XYZ, each component relative to white.
Vec3 xyz_from_rgb(const Vec3& c) {
  return {0.433895389f * c.x + 0.376242373f * c.y + 0.189862239f * c.z,
          0.212636822f * c.x + 0.715182982f * c.y + 0.072180196f * c.z,
          0.017752423f * c.x + 0.109465629f * c.y + 0.872781948f * c.z};
}
Vec3 rgb_from_xyz(const Vec3& c) {
  return {3.080341988f * c.x - 1.537398969f * c.y - 0.542943019f * c.z,
          -0.921178396f * c.x + 1.875929984f * c.y + 0.045248412f * c.z,
          0.052881293f * c.x - 0.204011206f * c.y + 1.151129913f * c.z};
}

// Converts to the linear opponent space in which images are filtered [1, spatial filtering].
Vec3 ycxcz_from_xyz(const Vec3& c) {
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}
Vec3 xyz_from_ycxcz(const Vec3& c) {
  const float y = (c.x + 16) / 116;
  return {y + c.y / 500, y, y - c.z / 200};
}

// Converts to CIE L*a*b* with chroma scaled by lightness, after Hunt [1, colour pipeline].
Vec3 hunt_lab_from_xyz(const Vec3& c) {
  constexpr float delta = 6.0f / 29;
  const auto f = [](float t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
  };
  const float fx = f(c.x), fy = f(c.y), fz = f(c.z);
  const float lightness = 116 * fy - 16;
  return {lightness, 0.01f * lightness * 500 * (fx - fy), 0.01f * lightness * 200 * (fy - fz)};
}

float hyab(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// HyAB distance of two filtered colours, compressed and mapped to [0,1] so that the first p_c of
// its range takes p_t of it [1, colour pipeline: redistribution]. The largest distance is that of
// green and blue.
class ColourDifference {
 public:
  ColourDifference()
      : largest_(std::pow(hyab(hunt_lab_from_xyz(xyz_from_rgb({0, 1, 0})),
                               hunt_lab_from_xyz(xyz_from_rgb({0, 0, 1}))),
                          q_c)) {}
  float operator()(const Vec3& a, const Vec3& b) const {
    const float d = std::pow(hyab(a, b), q_c), knee = p_c * largest_;
    if (d < knee) return p_t / knee * d;
    return std::min(1.0f, p_t + (d - knee) / (largest_ - knee) * (1 - p_t));
  }

 private:
  float largest_;
};

Kernel gaussian(double b, int radius, double pixels_per_degree) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i)
    kernel.push_back(float(std::exp(-sqr(pi * i / pixels_per_degree) / b)));
  return kernel;
}

PixelPlane blur(const PixelPlane& in, const Kernel& kernel, int threads) {
  return convolve_columns(convolve_rows(in, kernel, threads), kernel, threads);
}

// Filters a plane by the contrast sensitivity function. The filter is the sum of two Gaussians a
// sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees. It is cut to a square of three standard deviations
// of the widest Gaussian and normalised there [1, spatial filtering]. Each Gaussian is separable.
PixelPlane contrast_filter(const PixelPlane& in, const Sensitivity& s, double pixels_per_degree,
                           int threads) {
  const int radius = int(std::ceil(3 * std::sqrt(widest_b / (2 * pi * pi)) * pixels_per_degree));
  const auto kernel_and_mass = [&](double a, double b) {
    Kernel kernel = gaussian(b, radius, pixels_per_degree);
    double sum = 0;
    for (const float v : kernel) sum += double(v);
    for (float& v : kernel) v = float(double(v) / sum);
    return std::pair(kernel, a * std::sqrt(pi / b) * sum * sum);
  };
  const auto [kernel1, mass1] = kernel_and_mass(s.a1, s.b1);
  PixelPlane out = blur(in, kernel1, threads);
  if (s.a2 == 0) return out;
  const auto [kernel2, mass2] = kernel_and_mass(s.a2, s.b2);
  const PixelPlane other = blur(in, kernel2, threads);
  const auto weight1 = float(mass1 / (mass1 + mass2)), weight2 = float(mass2 / (mass1 + mass2));
  for (size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = weight1 * out.values[i] + weight2 * other.values[i];
  return out;
}

// Converts clamped linear colours to YCxCz planes.
Planes opponent_planes(const Image& image, int threads) {
  Planes planes;
  planes.fill(PixelPlane(image.width, image.height));
  parallel_for(size_t(image.height), threads, [&](size_t y) {
    for (size_t i = y * size_t(image.width); i < (y + 1) * size_t(image.width); ++i) {
      const Rgb p = image.pixels[i];
      const Rgb c = is_finite(p) ? clamp01(p) : Rgb{0};
      const Vec3 v = ycxcz_from_xyz(xyz_from_rgb({c.r, c.g, c.b}));
      for (size_t k = 0; k < 3; ++k) planes[k].values[i] = v[k];
    }
  });
  return planes;
}

// Filters an image's colours, clamps them to the display's gamut and converts them to Hunt-adjusted
// L*a*b*, in place.
void perceived_colours(Planes& planes, double pixels_per_degree, int threads) {
  planes[0] = contrast_filter(planes[0], achromatic, pixels_per_degree, threads);
  planes[1] = contrast_filter(planes[1], red_green, pixels_per_degree, threads);
  planes[2] = contrast_filter(planes[2], blue_yellow, pixels_per_degree, threads);
  const auto width = size_t(planes[0].width);
  parallel_for(size_t(planes[0].height), threads, [&](size_t y) {
    for (size_t i = y * width; i < (y + 1) * width; ++i) {
      const Vec3 c{planes[0].values[i], planes[1].values[i], planes[2].values[i]};
      const Vec3 rgb = max(Vec3{0.0f}, min(Vec3{1.0f}, rgb_from_xyz(xyz_from_ycxcz(c))));
      const Vec3 lab = hunt_lab_from_xyz(xyz_from_rgb(rgb));
      for (size_t k = 0; k < 3; ++k) planes[k].values[i] = lab[k];
    }
  });
}

// Strength of edges, and of points and lines: lengths of the first and of the second derivatives.
struct Features {
  PixelPlane edges, points;
};

// Scales a kernel's positive weights to the sum 1 and its negative ones to -1 [1, feature
// pipeline].
void normalise_by_sign(Kernel& kernel) {
  float positive = 0, negative = 0;
  for (const float v : kernel) (v > 0 ? positive : negative) += std::abs(v);
  for (float& v : kernel)
    if (v != 0) v /= v > 0 ? positive : negative;
}

PixelPlane gradient_length(const PixelPlane& lightness, const Kernel& derivative,
                           const Kernel& smooth, int threads) {
  PixelPlane out = convolve_columns(convolve_rows(lightness, derivative, threads), smooth, threads);
  const PixelPlane vertical =
      convolve_columns(convolve_rows(lightness, smooth, threads), derivative, threads);
  for (size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = std::sqrt(sqr(out.values[i]) + sqr(vertical.values[i]));
  return out;
}

// Computes features of the achromatic plane by derivatives of a Gaussian whose standard deviation
// is half the width of a feature [1, feature pipeline].
Features detect_features(const PixelPlane& achromatic_plane, double pixels_per_degree,
                         int threads) {
  PixelPlane lightness = achromatic_plane;
  for (float& v : lightness.values) v = (v + 16) / 116;  // to [0,1]
  const double sigma = 0.5 * feature_width_deg * pixels_per_degree;
  const int radius = int(std::ceil(3 * sigma));
  Kernel smooth, edge, point;
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-sqr(i / sigma) / 2);
    smooth.push_back(float(g));
    edge.push_back(float(-i * g));
    point.push_back(float((sqr(i / sigma) - 1) * g));
  }
  for (Kernel* kernel : {&smooth, &edge, &point}) normalise_by_sign(*kernel);
  return {gradient_length(lightness, edge, smooth, threads),
          gradient_length(lightness, point, smooth, threads)};
}

}  // namespace

std::vector<float> flip_errors(const Image& image, const Image& reference, double pixels_per_degree,
                               int threads) {
  TROFFER_CHECK(image.width == reference.width && image.height == reference.height);
  TROFFER_CHECK(pixels_per_degree > 0);
  Planes a = opponent_planes(image, threads), b = opponent_planes(reference, threads);
  const Features features_a = detect_features(a[0], pixels_per_degree, threads);
  const Features features_b = detect_features(b[0], pixels_per_degree, threads);
  perceived_colours(a, pixels_per_degree, threads);
  perceived_colours(b, pixels_per_degree, threads);

  const ColourDifference colour_difference;
  std::vector<float> errors(image.pixels.size());
  const auto width = size_t(image.width);
  parallel_for(size_t(image.height), threads, [&](size_t y) {
    for (size_t i = y * width; i < (y + 1) * width; ++i) {
      const float colour = colour_difference({a[0].values[i], a[1].values[i], a[2].values[i]},
                                             {b[0].values[i], b[1].values[i], b[2].values[i]});
      const float edge = std::abs(features_a.edges.values[i] - features_b.edges.values[i]);
      const float point = std::abs(features_a.points.values[i] - features_b.points.values[i]);
      const float feature = std::min(1.0f, std::pow(std::max(edge, point) / std::sqrt(2.0f), q_f));
      errors[i] = std::pow(colour, 1 - feature);  // [1, final difference]
    }
  });
  return errors;
}

}  // namespace troffer
