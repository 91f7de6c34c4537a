// Numerical integration for tests: Gauss–Legendre rules of any order, in one and two dimensions,
// fixed and adaptive.
// References: [1] Press et al., "Numerical Recipes", 3rd ed., §4.6.
#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

namespace troffer::test {

// Nodes and weights on [0,1]; exact for polynomials up to degree 2n - 1.
template <class T = double>
struct GaussLegendre {
  std::vector<T> nodes, weights;

  explicit GaussLegendre(int n) : nodes(size_t(n)), weights(size_t(n)) {
    // Newton iteration on the Legendre polynomial P_n from Chebyshev-like first guesses [1].
    const T pi_t = std::acos(T(-1));
    for (int i = 0; i < n; ++i) {
      T z = std::cos(pi_t * (T(i) + T(0.75)) / (T(n) + T(0.5)));
      T slope = 0;
      for (int pass = 0; pass < 100; ++pass) {
        T p = 1, previous = 0;
        for (int j = 0; j < n; ++j) {
          const T older = previous;
          previous = p;
          p = (T(2 * j + 1) * z * previous - T(j) * older) / T(j + 1);
        }
        slope = T(n) * (z * p - previous) / (z * z - 1);
        const T step = p / slope;
        z -= step;
        if (std::abs(step) < T(1e-16)) break;
      }
      nodes[size_t(i)] = (1 - z) / 2;
      weights[size_t(i)] = 1 / ((1 - z * z) * slope * slope);
    }
  }
};

template <class T = double>
const GaussLegendre<T>& gauss_legendre(int n) {
  static std::map<int, GaussLegendre<T>> rules;  // tests are single-threaded
  return rules.try_emplace(n, n).first->second;
}

// ∫_a^b f(x) dx with one rule of order n.
template <class T, class F>
T integrate(const F& f, T a, T b, int n) {
  const auto& rule = gauss_legendre<T>(n);
  T sum = 0;
  for (int i = 0; i < n; ++i)
    sum += rule.weights[size_t(i)] * T(f(a + (b - a) * rule.nodes[size_t(i)]));
  return sum * (b - a);
}

// ∫∫ f(x, y) dx dy over [ax,bx] × [ay,by] with a product rule of order n × n.
template <class T, class F>
T integrate_2d(const F& f, T ax, T bx, T ay, T by, int n) {
  return integrate([&](T x) { return integrate([&](T y) { return f(x, y); }, ay, by, n); }, ax, bx,
                   n);
}

// Like integrate, but halves intervals until the rule and its halves agree to `tolerance`
// (absolute, for the whole) or `depth` halvings are used up. For integrands with kinks and
// near-singularities.
template <class T, class F>
T integrate_adaptive(const F& f, T a, T b, T tolerance, int n = 8, int depth = 30) {
  const auto recurse = [&](const auto& self, T lo, T hi, T whole, T tol, int left) -> T {
    const T mid = (lo + hi) / 2;
    const T l = integrate(f, lo, mid, n), r = integrate(f, mid, hi, n);
    if (left == 0 || !(std::abs(l + r - whole) > tol)) return l + r;
    return self(self, lo, mid, l, tol / 2, left - 1) + self(self, mid, hi, r, tol / 2, left - 1);
  };
  return recurse(recurse, a, b, integrate(f, a, b, n), tolerance, depth);
}

// Like integrate_2d, but splits boxes into four until an n × n rule agrees with its quarters.
template <class T, class F>
T integrate_adaptive_2d(const F& f, T ax, T bx, T ay, T by, T tolerance, int n = 6,
                        int depth = 12) {
  const auto recurse = [&](const auto& self, T x0, T x1, T y0, T y1, T whole, T tol,
                           int left) -> T {
    const T xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
    const T q00 = integrate_2d(f, x0, xm, y0, ym, n), q10 = integrate_2d(f, xm, x1, y0, ym, n);
    const T q01 = integrate_2d(f, x0, xm, ym, y1, n), q11 = integrate_2d(f, xm, x1, ym, y1, n);
    const T sum = q00 + q10 + q01 + q11;
    if (left == 0 || !(std::abs(sum - whole) > tol)) return sum;
    return self(self, x0, xm, y0, ym, q00, tol / 4, left - 1) +
           self(self, xm, x1, y0, ym, q10, tol / 4, left - 1) +
           self(self, x0, xm, ym, y1, q01, tol / 4, left - 1) +
           self(self, xm, x1, ym, y1, q11, tol / 4, left - 1);
  };
  return recurse(recurse, ax, bx, ay, by, integrate_2d(f, ax, bx, ay, by, n), tolerance, depth);
}

}  // namespace troffer::test
