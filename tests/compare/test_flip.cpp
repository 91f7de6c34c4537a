// FLIP compared with a slow, independent reference and with closed forms; its properties.
// References: [1] Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>

#include "base/random.h"
#include "compare/flip.h"

using namespace troffer;

namespace {

// A literal transcription of [1]: double precision, full two-dimensional kernels, no separation.
namespace naive {

using Colour = std::array<double, 3>;
using Grid = std::vector<std::vector<double>>;  // [y][x]

constexpr double pi = 3.141592653589793;
const std::array<Colour, 3> xyz_of_rgb{
    {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
     {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
     {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

Colour multiply(const std::array<Colour, 3>& m, const Colour& v) {
  Colour out{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  return out;
}

std::array<Colour, 3> inverse(const std::array<Colour, 3>& m) {
  std::array<Colour, 3> out{};
  const auto minor = [&](size_t i, size_t j) {
    const size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const double det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) out[j][i] = minor(i, j) / det;
  return out;
}

Colour white() {
  return multiply(xyz_of_rgb, {1, 1, 1});
}

Colour ycxcz(const Colour& rgb) {
  const Colour v = multiply(xyz_of_rgb, rgb), n = white();
  const double x = v[0] / n[0], y = v[1] / n[1], z = v[2] / n[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour rgb_of_ycxcz(const Colour& c) {
  const Colour n = white();
  const double y = (c[0] + 16) / 116;
  return multiply(inverse(xyz_of_rgb),
                  {(y + c[1] / 500) * n[0], y * n[1], (y - c[2] / 200) * n[2]});
}

Colour hunt_lab(const Colour& rgb) {
  const Colour v = multiply(xyz_of_rgb, rgb), n = white();
  Colour f{};
  for (size_t i = 0; i < 3; ++i) {
    const double t = v[i] / n[i], delta = 6.0 / 29;
    f[i] = t > std::pow(delta, 3) ? std::pow(t, 1.0 / 3) : t / (3 * delta * delta) + 4.0 / 29;
  }
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

double hyab(const Colour& a, const Colour& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

double colour_error(const Colour& lab_a, const Colour& lab_b) {
  const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  const double e = std::pow(hyab(lab_a, lab_b), 0.7), knee = 0.4 * largest;
  return e < knee ? 0.95 / knee * e : 0.95 + (e - knee) / (largest - knee) * 0.05;
}

Grid kernel(int radius, const std::function<double(double, double)>& f) {
  Grid out;
  for (int y = -radius; y <= radius; ++y) {
    out.emplace_back();
    for (int x = -radius; x <= radius; ++x) out.back().push_back(f(x, y));
  }
  return out;
}

void scale(Grid& k, double by) {
  for (auto& row : k)
    for (double& v : row) v *= by;
}

Grid csf(double a1, double b1, double a2, double b2, double ppd) {
  const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  Grid k = kernel(radius, [&](double x, double y) {
    const double r2 = (x * x + y * y) / (ppd * ppd);
    return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * r2 / b1) +
           a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * r2 / b2);
  });
  double sum = 0;
  for (const auto& row : k)
    for (const double v : row) sum += v;
  scale(k, 1 / sum);
  return k;
}

Grid feature_kernel(bool is_edge, bool is_vertical, double ppd) {
  const double sigma = 0.5 * 0.082 * ppd;
  Grid k = kernel(int(std::ceil(3 * sigma)), [&](double x, double y) {
    const double g = std::exp(-(x * x + y * y) / (2 * sigma * sigma)), t = is_vertical ? y : x;
    return is_edge ? -t * g : (t * t / (sigma * sigma) - 1) * g;
  });
  double positive = 0, negative = 0;
  for (const auto& row : k)
    for (const double v : row) (v > 0 ? positive : negative) += std::abs(v);
  for (auto& row : k)
    for (double& v : row) v /= v > 0 ? positive : negative;
  return k;
}

double convolve(const Grid& in, const Grid& k, int x, int y) {
  const int radius = int(k.size()) / 2, h = int(in.size()), w = int(in[0].size());
  double sum = 0;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i)
      sum += k[size_t(j + radius)][size_t(i + radius)] *
             in[size_t(std::clamp(y + j, 0, h - 1))][size_t(std::clamp(x + i, 0, w - 1))];
  return sum;
}

struct Prepared {
  std::array<Grid, 3> planes;
  Grid lightness;

  explicit Prepared(const Image& image) {
    for (auto& plane : planes)
      plane.assign(size_t(image.height), std::vector<double>(size_t(image.width)));
    lightness = planes[0];
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Rgb p = clamp01(image.at(x, y));
        const Colour c = ycxcz({double(p.r), double(p.g), double(p.b)});
        for (size_t k = 0; k < 3; ++k) planes[k][size_t(y)][size_t(x)] = c[k];
        lightness[size_t(y)][size_t(x)] = (c[0] + 16) / 116;
      }
  }
  Colour perceived(const std::array<Grid, 3>& filters, int x, int y) const {
    Colour c{};
    for (size_t k = 0; k < 3; ++k) c[k] = convolve(planes[k], filters[k], x, y);
    c = rgb_of_ycxcz(c);
    for (double& v : c) v = std::clamp(v, 0.0, 1.0);
    return hunt_lab(c);
  }
  double feature(const Grid& horizontal, const Grid& vertical, int x, int y) const {
    return std::hypot(convolve(lightness, horizontal, x, y), convolve(lightness, vertical, x, y));
  }
};

double flip(const Image& image, const Image& reference, int x, int y, double ppd) {
  const Prepared a(image), b(reference);
  const std::array<Grid, 3> filters{csf(1, 0.0047, 0, 1e-5, ppd), csf(1, 0.0053, 0, 1e-5, ppd),
                                    csf(34.1, 0.04, 13.5, 0.025, ppd)};
  const double colour = colour_error(a.perceived(filters, x, y), b.perceived(filters, x, y));
  double feature = 0;
  for (const bool is_edge : {false, true}) {
    const Grid h = feature_kernel(is_edge, false, ppd), v = feature_kernel(is_edge, true, ppd);
    feature = std::max(feature, std::abs(a.feature(h, v, x, y) - b.feature(h, v, x, y)));
  }
  return std::pow(colour, 1 - std::pow(feature / std::sqrt(2.0), 0.5));
}

}  // namespace naive

Image random_image(int width, int height, uint64_t seed, float contrast) {
  Random random(seed);
  Image image(width, height);
  for (Rgb& p : image.pixels) {
    const auto value = [&] { return 0.5f + contrast * (random.next_float() - 0.5f); };
    p.r = value();
    p.g = value();
    p.b = value();
  }
  return image;
}

double flip_of_constants(Rgb a, Rgb b) {
  return double(flip_errors(Image(9, 7, a), Image(9, 7, b))[31]);
}

}  // namespace

TEST_CASE("FLIP equals its literal reference, pixel by pixel") {
  struct Case {
    float contrast_a, contrast_b;
    double ppd;
  };
  uint64_t seed = 1;
  for (const Case c : {Case{1, 1, 67}, Case{1, 0.05f, 67}, Case{2, 1, 67}, Case{1, 1, 20}}) {
    const Image a = random_image(31, 23, seed++, c.contrast_a);
    Image b = random_image(31, 23, seed++, c.contrast_b);
    for (int x = 10; x < 31; ++x)  // edges, points and noise
      for (int y = 0; y < 12; ++y) b.at(x, y) = Rgb{0.9f, 0.1f, 0.2f};
    b.at(5, 5) = Rgb{1, 1, 1};
    const std::vector<float> errors = flip_errors(a, b, c.ppd, 2);
    REQUIRE(errors.size() == a.pixels.size());
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(5, 5), std::pair(10, 11), std::pair(9, 3),
                               std::pair(20, 6), std::pair(30, 22), std::pair(15, 17)}) {
      CAPTURE(x);
      CAPTURE(y);
      CHECK(double(errors[size_t(y * 31 + x)]) ==
            doctest::Approx(naive::flip(a, b, x, y, c.ppd)).epsilon(1e-4));
    }
  }
}

TEST_CASE("FLIP of constant images is the compressed distance of their colours") {
  for (const auto& [a, b] : {std::pair(Rgb{0, 0, 0}, Rgb{1, 1, 1}),
                             std::pair(Rgb{0.2f, 0.5f, 0.1f}, Rgb{0.2f, 0.4f, 0.1f}),
                             std::pair(Rgb{1, 0, 0}, Rgb{0, 0, 1}),
                             std::pair(Rgb{0.001f, 0.002f, 0}, Rgb{0, 0, 0.003f})}) {
    const auto lab = [](Rgb c) { return naive::hunt_lab({double(c.r), double(c.g), double(c.b)}); };
    CHECK(flip_of_constants(a, b) ==
          doctest::Approx(naive::colour_error(lab(a), lab(b))).epsilon(2e-4));
  }
  // Black and white have HyAB 100. Green and blue have the largest distance, 1 by definition.
  CHECK(flip_of_constants(Rgb{0}, Rgb{1}) > 0.95);
  CHECK(flip_of_constants({0, 1, 0}, {0, 0, 1}) == doctest::Approx(1).epsilon(1e-5));
}

TEST_CASE("FLIP is 0 on equal images, symmetric and within [0,1]") {
  const Image a = random_image(40, 30, 100, 2), b = random_image(40, 30, 101, 2);
  const auto forth = flip_errors(a, b), back = flip_errors(b, a);
  for (size_t i = 0; i < forth.size(); ++i) {
    CHECK(forth[i] >= 0);
    CHECK(forth[i] <= 1);
    CHECK(forth[i] == back[i]);
  }
  for (const float e : flip_errors(a, a)) CHECK(e == 0);
  CHECK(flip_errors(a, b, 67, 1) == flip_errors(a, b, 67, 3));
  // Images smaller than the filters, and filters smaller than a pixel.
  CHECK(flip_errors(Image(1, 1, Rgb{1}), Image(1, 1)).size() == 1);
  for (const float e : flip_errors(a, b, 0.1)) CHECK(std::isfinite(e));
}

TEST_CASE("a visible change counts more than noise that the eye averages") {
  const Image grey(64, 64, Rgb{0.5f});
  Image dithered = grey, shifted = grey;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const float d = (x + y) % 2 == 0 ? 0.05f : -0.05f;
      dithered.at(x, y) = Rgb{0.5f + d};
      shifted.at(x, y) = Rgb{0.55f};
    }
  const size_t middle = 32 * 64 + 32;
  CHECK(flip_errors(dithered, grey)[middle] < 0.5f * flip_errors(shifted, grey)[middle]);
}
