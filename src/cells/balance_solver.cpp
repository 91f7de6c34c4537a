#include "cells/balance_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace troffer {

namespace {

// Previous directions that a new one is made orthogonal to.
constexpr size_t kept_directions = 8;
constexpr size_t cells_at_a_time = 8192;
// If this many steps leave more than this share of the residual, as many plain bounces follow.
constexpr int steps_of_look = 16;
constexpr double least_progress = 0.5;

using Field = std::vector<Rgb>;
using Channels = std::array<double, 3>;

struct Direction {
  Field p, image;  // image: p - W p
  Channels square{};
};

class Solver {
 public:
  Solver(const LightOperator& w, const Field& d, const std::vector<float>& weights, int threads)
      : w_(w),
        weights_(weights),
        threads_(threads),
        partial_((d.size() + cells_at_a_time - 1) / cells_at_a_time) {
    result_.light.assign(d.size(), Rgb{0});
    residual_ = d;
  }

  Balance solve(double most_left, int most_iterations) {
    double before = sum(residual_);
    while (result_.iterations < most_iterations) {
      step();
      const double left = sum(residual_);
      if (left <= most_left * sum(result_.light)) break;
      if (result_.iterations % steps_of_look != 0) continue;
      if (left > least_progress * before)
        for (int k = 0; k < steps_of_look && result_.iterations < most_iterations; ++k) bounce();
      before = sum(residual_);
    }
    return std::move(result_);
  }

 private:
  // Takes one plain bounce. It is slow, but the largest entry of the residual never grows as long
  // as every row of W sums to less than one.
  void bounce() {
    Field next;
    w_(residual_, next);
    ++result_.iterations;
    each([&](size_t i) {
      result_.light[i] += residual_[i];
      residual_[i] = next[i];
    });
    directions_.clear();
    oldest_ = 0;
  }

  void step() {
    Direction next{residual_, {}, {}};
    w_(next.p, next.image);
    ++result_.iterations;
    each([&](size_t i) { next.image[i] = next.p[i] - next.image[i]; });
    for (const Direction& before : directions_) {
      const Channels share = quotient(dot(next.image, before.image), before.square);
      subtract(before, share, next);
    }
    next.square = dot(next.image, next.image);
    const Channels step = quotient(dot(residual_, next.image), next.square);
    const Rgb s{float(step[0]), float(step[1]), float(step[2])};
    each([&](size_t i) {
      result_.light[i] += s * next.p[i];
      residual_[i] = residual_[i] - s * next.image[i];
    });
    if (directions_.size() < kept_directions)
      directions_.push_back(std::move(next));
    else
      directions_[oldest_++ % kept_directions] = std::move(next);
  }

  void subtract(const Direction& before, const Channels& share, Direction& next) const {
    const Rgb s{float(share[0]), float(share[1]), float(share[2])};
    each([&](size_t i) {
      next.p[i] = next.p[i] - s * before.p[i];
      next.image[i] = next.image[i] - s * before.image[i];
    });
  }

  static Channels quotient(const Channels& a, const Channels& b) {
    Channels q{};
    for (size_t c = 0; c < 3; ++c) q[c] = b[c] > 0 ? a[c] / b[c] : 0;
    return q;
  }

  // Inner product by the entries' weights. The order of summation does not depend on threads.
  Channels dot(const Field& a, const Field& b) {
    chunks([&](size_t chunk, size_t first, size_t end) {
      Channels sum{};
      for (size_t i = first; i < end; ++i)
        for (size_t c = 0; c < 3; ++c)
          sum[c] += double(weights_[i]) * double(a[i][c]) * double(b[i][c]);
      partial_[chunk] = sum;
    });
    Channels all{};
    for (const Channels& p : partial_)
      for (size_t c = 0; c < 3; ++c) all[c] += p[c];
    return all;
  }

  double sum(const Field& a) const {
    double all = 0;
    for (size_t i = 0; i < a.size(); ++i)
      all += double(weights_[i]) *
             (std::abs(double(a[i].r)) + std::abs(double(a[i].g)) + std::abs(double(a[i].b)));
    return all;
  }

  template <typename F>
  void chunks(const F& f) const {
    parallel_for(partial_.size(), threads_, [&](size_t chunk) {
      f(chunk, chunk * cells_at_a_time,
        std::min(result_.light.size(), (chunk + 1) * cells_at_a_time));
    });
  }
  template <typename F>
  void each(const F& f) const {
    chunks([&](size_t, size_t first, size_t end) {
      for (size_t i = first; i < end; ++i) f(i);
    });
  }

  const LightOperator& w_;
  const std::vector<float>& weights_;
  int threads_;
  std::vector<Channels> partial_;
  Balance result_;
  Field residual_;  // D + W E - E
  std::vector<Direction> directions_;
  size_t oldest_ = 0;
};

}  // namespace

Balance solve_balance(const LightOperator& w, const Field& d, const std::vector<float>& weights,
                      double most_left, int most_iterations, int threads) {
  return Solver(w, d, weights, threads).solve(most_left, most_iterations);
}

}  // namespace troffer
