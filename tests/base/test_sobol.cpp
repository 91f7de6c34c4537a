// Owen-scrambled Sobol groups: stratification, uniformity, independence of streams.
#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <set>
#include <vector>

#include "base/random.h"
#include "support/chi_square.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// True if each of the 2^a × 2^(m-a) boxes holds exactly one point, for every a.
bool is_net(const std::vector<Vec2>& points, unsigned m) {
  for (unsigned a = 0; a <= m; ++a) {
    std::set<uint32_t> boxes;
    for (const Vec2& p : points) {
      const auto i = uint32_t(double(p.x) * double(1u << a));
      const auto j = uint32_t(double(p.y) * double(1u << (m - a)));
      boxes.insert((i << (m - a)) | j);
    }
    if (boxes.size() != points.size()) return false;
  }
  return true;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - 0.5) * (b[i] - 0.5);
  return 12 * sum / double(a.size());
}

}  // namespace

TEST_CASE("Sobol points from tables equal those from direction numbers") {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const uint32_t index = i < 64 ? uint32_t(i) : random.next_u32();
    for (int d = 0; d < sobol_dimensions; ++d) {
      uint32_t x = 0;
      for (unsigned k = 0; k < 32; ++k)
        if ((index >> k) & 1u) x ^= sobol_matrices_reversed()[size_t(d)][k];
      CHECK(sobol_reversed(index, d) == x);
    }
  }
}

TEST_CASE("the plain Sobol sequence begins as published") {
  // Joe & Kuo's first points, which visit indices along a Gray code.
  const double expected[8][3] = {{0, 0, 0},
                                 {0.5, 0.5, 0.5},
                                 {0.75, 0.25, 0.25},
                                 {0.25, 0.75, 0.75},
                                 {0.375, 0.375, 0.625},
                                 {0.875, 0.875, 0.125},
                                 {0.625, 0.125, 0.875},
                                 {0.125, 0.625, 0.375}};
  for (uint32_t i = 0; i < 8; ++i)
    for (int d = 0; d < 3; ++d)
      CHECK(double(reverse_bits(sobol_reversed(i ^ (i >> 1), d))) * 0x1p-32 == expected[i][d]);
}

TEST_CASE("scrambled points of a group are (0,m,2)-nets, also from any aligned block") {
  for (const uint64_t stream : {0ull, 1ull, 123456789ull})
    for (const uint32_t purpose : {0u, 7u})
      for (unsigned m = 0; m <= 10; ++m)
        for (const uint32_t block : {0u, 5u}) {
          std::vector<Vec2> points;
          for (uint32_t i = 0; i < (1u << m); ++i)
            points.push_back(SobolGroup(stream, purpose, (block << m) + i).get2());
          INFO("stream ", stream, " purpose ", purpose, " m ", m, " block ", block);
          CHECK(is_net(points, m));
        }
}

TEST_CASE("every projection on one axis is stratified") {
  for (unsigned m = 0; m <= 12; ++m)
    for (int d = 0; d < sobol_dimensions; ++d) {
      std::set<uint32_t> cells;
      for (uint32_t i = 0; i < (1u << m); ++i)
        cells.insert(uint32_t(double(SobolGroup(42, 3, i).get(d)) * double(1u << m)));
      CHECK(cells.size() == (1u << m));
    }
}

TEST_CASE("all points lie in [0,1)") {
  float least = 1, most = 0;
  for (uint32_t i = 0; i < 100000; ++i)
    for (int d = 0; d < sobol_dimensions; ++d) {
      const float x = SobolGroup(i * 77, i % 5, i).get(d);
      least = std::min(least, x);
      most = std::max(most, x);
    }
  CHECK(least >= 0);
  CHECK(most < 1);
  CHECK(unit_float(0xffffffffu) < 1);
}

TEST_CASE("one point of many streams is uniform in its pairs of dimensions") {
  constexpr int bins = 16, n = 100000;
  const double significance = sidak(1e-3, 10);
  for (int a = 0; a < sobol_dimensions; ++a)
    for (int b = a + 1; b < sobol_dimensions; ++b) {
      std::vector<double> observed(bins * bins), expected(bins * bins, double(n) / (bins * bins));
      for (int i = 0; i < n; ++i) {
        const SobolGroup g(hash_of(uint64_t(i), 9), 2, 5);
        observed[size_t(g.get(a) * bins) * bins + size_t(g.get(b) * bins)] += 1;
      }
      const auto r = chi_square_test(observed, expected, 1, significance);
      INFO("dimensions ", a, " ", b);
      CHECK_MESSAGE(r.is_accepted, r.text());
    }
}

TEST_CASE("streams of different purposes are uncorrelated") {
  // Sums over whole sets of Sobol points nearly cancel. A bound of five standard deviations of
  // independent numbers is therefore generous.
  constexpr uint32_t n = 4096;
  const auto column = [](uint64_t stream, uint32_t purpose, int d) {
    std::vector<double> v(n);
    for (uint32_t i = 0; i < n; ++i) v[i] = double(SobolGroup(stream, purpose, i).get(d));
    return v;
  };
  const double bound = 5 / std::sqrt(double(n));
  for (int d = 0; d < sobol_dimensions; ++d) {
    const auto base = column(10, 4, d);
    for (const uint32_t purpose : {0u, 1u, 2u, 3u, 5u, 6u, 7u, 8u})
      for (int e = 0; e < sobol_dimensions; ++e)
        CHECK(std::abs(correlation(base, column(10, purpose, e))) < bound);
    for (const uint64_t stream : {11ull, 12ull, 14ull, 26ull, 1ull << 40})
      for (int e = 0; e < sobol_dimensions; ++e)
        CHECK(std::abs(correlation(base, column(stream, 4, e))) < bound);
    for (int e = d + 1; e < sobol_dimensions; ++e)
      CHECK(std::abs(correlation(base, column(10, 4, e))) < bound);
  }
}

TEST_CASE("few scrambled points integrate a smooth function better than random ones") {
  double sobol = 0, random_error = 0;
  Random random(8);
  constexpr int trials = 200, n = 256;
  for (int t = 0; t < trials; ++t) {
    double a = 0, b = 0;
    for (uint32_t i = 0; i < n; ++i) {
      const Vec2 u = SobolGroup(uint64_t(t), 1, i).get2(), v = random.next_vec2();
      a += std::exp(double(u.x * u.y)) / n;
      b += std::exp(double(v.x * v.y)) / n;
    }
    constexpr double exact = 1.3179021514544038949;  // Σ 1 / (k! (k+1)²)
    sobol += (a - exact) * (a - exact);
    random_error += (b - exact) * (b - exact);
  }
  CHECK(sobol * 1000 < random_error);
}

TEST_CASE("the plain stream is uniform and hashes are bijections of bits") {
  Random random(77);
  std::vector<double> observed(64), expected(64, 100000.0 / 64);
  for (int i = 0; i < 100000; ++i) observed[size_t(random.next_float() * 64)] += 1;
  const auto r = chi_square_test(observed, expected, 1, 1e-4);
  CHECK_MESSAGE(r.is_accepted, r.text());
  for (const uint32_t x : {0u, 1u, 0x80000000u, 0x12345678u})
    CHECK(reverse_bits(reverse_bits(x)) == x);
  CHECK(reverse_bits(1u) == 0x80000000u);
  std::set<uint32_t> images;
  for (uint32_t i = 0; i < 4096; ++i) images.insert(nested_uniform_scramble(i << 20, 99) >> 20);
  CHECK(images.size() == 4096);
}

TEST_CASE("groups drawn at once equal those drawn one by one, bit for bit") {
  constexpr size_t n = 1003;  // not a multiple of any vector register's width
  std::vector<uint64_t> streams(n);
  std::vector<uint32_t> samples(n);
  for (size_t i = 0; i < n; ++i) {
    streams[i] = hash_of(i / 7, uint64_t(5));
    samples[i] = uint32_t(i * 31 % 4096);
  }
  for (const int dimensions : {2, 3, 4}) {
    std::vector<float> out(n * size_t(dimensions), -1.0f);
    sobol_groups(streams.data(), samples.data(), n, 9, dimensions, out.data());
    size_t different = 0;
    for (size_t i = 0; i < n; ++i)
      for (int d = 0; d < dimensions; ++d)
        different += out[size_t(d) * n + i] != SobolGroup(streams[i], 9, samples[i]).get(d);
    CHECK(different == 0);
  }
}

TEST_CASE("blocks hold the points of their samples, neighbours together") {
  for (const uint32_t n : {1u, 16u, 64u, 512u, 48u}) {
    const SobolBlocks blocks(n);
    REQUIRE(blocks.size() == n);
    for (uint32_t block = 0; block < 5; ++block) {
      std::vector<float> drawn(3 * n);
      blocks.draw(99 + block, 4, block, 3, drawn.data());
      std::set<std::array<float, 3>> of_blocks, of_groups;
      for (uint32_t i = 0; i < n; ++i) {
        of_blocks.insert({drawn[i], drawn[n + i], drawn[2 * n + i]});
        const SobolGroup g(99 + block, 4, block * n + i);
        of_groups.insert({g.get(0), g.get(1), g.get(2)});
      }
      CHECK(of_blocks == of_groups);
      if (n < 32 || n == 48) continue;
      // Every 16 points lie in one of n / 16 parts, which are squares or twice as wide as high.
      const uint32_t bits = uint32_t(std::countr_zero(n / 16));
      const uint32_t columns = 1u << ((bits + 1) / 2), rows = 1u << (bits / 2);
      size_t strays = 0;
      for (uint32_t i = 0; i < n; ++i) {
        const uint32_t first = i / 16 * 16;
        strays += uint32_t(drawn[i] * float(columns)) != uint32_t(drawn[first] * float(columns)) ||
                  uint32_t(drawn[n + i] * float(rows)) != uint32_t(drawn[n + first] * float(rows));
      }
      CHECK(strays == 0);
    }
  }
}
