#include "select/learned_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"
#include "base/units.h"

namespace troffer {

namespace {

// Share of the samples that the tree chooses. By judgement, as in guided gathers and path guiding.
constexpr float share_of_tree = 0.25f;
// The rest by the variance of light samples in three public rooms (docs/log/light-sampling.md).
// Blocks of a sky are side × side.
constexpr uint32_t blocks_side = 16;
// Regions of fewer observations than twice this are divided no further.
constexpr size_t least_of_region = 512;
// The estimate of the region around counts as so many observations of a block.
constexpr double prior_observations = 16;

uint32_t main_axis(const Vec3& v) {
  const float x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

}  // namespace

uint32_t LearnedLights::class_of(const Vec3& n) {
  const uint32_t axis = main_axis(n);
  return 2 * axis + (n[axis] < 0 ? 1u : 0u);
}

uint32_t LearnedLights::block_of(const Part& part, const Vec2& square) {
  const auto along = [&](float t) {
    return std::min(uint32_t(std::max(t, 0.0f) * float(part.side)), part.side - 1);
  };
  return part.first + along(square.y) * part.side + along(square.x);
}

uint32_t LearnedLights::block_of(const LightObservation& o) const {
  return slots_[o.primitive] < 0 ? 0 : block_of(part_of(o.primitive), o.square);
}

// Divides the observations into regions, and computes their shares.
struct LearnedLights::Teacher {
  LearnedLights& out;
  std::vector<LightObservation> observations;
  std::vector<double> sizes;  // of a block: 1 / number of blocks of its part

  using Means = std::vector<double>;  // of each block: mean squared light
  using Iterator = std::vector<LightObservation>::iterator;

  // Estimates the blocks from observations and the estimate `around`.
  Means estimate(Iterator first, Iterator last, const Means& around) const {
    Means sums(out.blocks_), counts(out.blocks_);
    for (Iterator o = first; o != last; ++o) {
      const uint32_t b = out.block_of(*o);
      sums[b] += sqr(double(o->light));
      ++counts[b];
    }
    for (uint32_t b = 0; b < out.blocks_; ++b)
      sums[b] = (sums[b] + prior_observations * around[b]) / (counts[b] + prior_observations);
    return sums;
  }

  uint32_t add_region(const Means& means) {
    double sum = 0;
    for (uint32_t b = 0; b < out.blocks_; ++b) sum += std::sqrt(means[b]) * sizes[b];
    double before = 0;
    for (uint32_t b = 0; b < out.blocks_; ++b) {
      out.shares_.push_back(float(before));
      before += sum > 0 ? std::sqrt(means[b]) * sizes[b] / sum : 1.0 / double(out.blocks_);
    }
    out.shares_.push_back(1);
    return uint32_t(out.regions_++);
  }

  // Makes the tree of observations [first, last) in nodes_[at].
  void divide(uint32_t at, Iterator first, Iterator last, const Means& around) {
    const Means means = estimate(first, last, around);
    Box box;
    for (Iterator o = first; o != last; ++o) box.grow(o->position);
    const auto n = size_t(last - first);
    const uint32_t axis = n > 0 ? main_axis(box.extent()) : 0;
    const size_t a = axis;
    if (n < 2 * least_of_region || !(box.upper[a] > box.lower[a])) {
      out.nodes_[at].child = add_region(means);
      return;
    }
    const Iterator middle = first + (last - first) / 2;
    std::nth_element(first, middle, last,
                     [a](const LightObservation& l, const LightObservation& r) {
                       return l.position[a] < r.position[a];
                     });
    float split = middle->position[a];
    // All samples of one place go to the same side.
    Iterator border = std::partition(
        first, last, [a, split](const LightObservation& o) { return o.position[a] < split; });
    if (border == first) {
      split = std::nextafter(split, std::numeric_limits<float>::infinity());
      border = std::partition(
          first, last, [a, split](const LightObservation& o) { return o.position[a] < split; });
    }
    const auto child = uint32_t(out.nodes_.size());
    out.nodes_[at] = {split, axis, child};
    out.nodes_.resize(out.nodes_.size() + 2);
    divide(child, first, border, means);
    divide(child + 1, border, last, means);
  }

  void run() {
    for (const Part& p : out.parts_)
      sizes.insert(sizes.end(), size_t(p.side) * p.side, 1.0 / (double(p.side) * p.side));
    double sum = 0;
    for (const LightObservation& o : observations) sum += sqr(double(o.light));
    Means even(out.blocks_, sum / double(std::max<size_t>(observations.size(), 1)));
    if (out.parts_.size() == out.slots_.size()) even[0] = 0;  // no light has a place
    const Means all = estimate(observations.begin(), observations.end(), even);
    std::stable_sort(observations.begin(), observations.end(),
                     [](const LightObservation& l, const LightObservation& r) {
                       return class_of(l.normal) < class_of(r.normal);
                     });
    Iterator first = observations.begin();
    for (uint32_t c = 0; c < out.roots_.size(); ++c) {
      const Iterator last = std::find_if(first, observations.end(), [c](const LightObservation& o) {
        return class_of(o.normal) > c;
      });
      out.roots_[c] = uint32_t(out.nodes_.size());
      out.nodes_.emplace_back();
      divide(out.roots_[c], first, last, all);
      first = last;
    }
  }
};

LearnedLights::LearnedLights(const Scene& scene, const LightPrimitives& primitives,
                             const LightTree& tree, std::vector<LightObservation> observations)
    : scene_(scene), primitives_(primitives), tree_(tree), slots_(primitives.size(), -1) {
  for (const uint32_t i : primitives.at_infinity()) {
    const bool has_blocks = has_square_of_direction(scene, primitives[i]);
    slots_[i] = int32_t(parts_.size());
    parts_.push_back({i, blocks_, has_blocks ? blocks_side : 1});
    blocks_ += parts_.back().side * parts_.back().side;
  }
  Teacher teacher{*this, std::move(observations), {1.0}};
  teacher.run();
}

const float* LearnedLights::shares_at(const Vec3& x, const Vec3& n) const {
  uint32_t at = roots_[class_of(n)];
  while (nodes_[at].axis != Node::leaf) {
    const Node& node = nodes_[at];
    at = node.child + (x[node.axis] < node.split ? 0u : 1u);
  }
  return shares_.data() + size_t(nodes_[at].child) * (blocks_ + 1);
}

float LearnedLights::pmf_of_block(const float* shares, const Vec3& x, const Vec3& n,
                                  bool both_sides, const Part& part, const Vec2& square) const {
  const uint32_t b = block_of(part, square);
  return lerp((shares[b + 1] - shares[b]) * float(part.side * part.side),
              tree_.pmf(x, n, both_sides, part.primitive), share_of_tree);
}

float LearnedLights::pmf_at_infinity(const Vec3& x, const Vec3& n, bool both_sides,
                                     uint32_t primitive, const Vec3& wi) const {
  const Part& part = part_of(primitive);
  const Vec2 square =
      part.side > 1 ? square_of_direction(scene_, primitives_[primitive], wi) : Vec2{};
  return pmf_of_block(shares_at(x, n), x, n, both_sides, part, square);
}

float LearnedLights::factor_of_placed(const Vec3& x, const Vec3& n, bool both_sides) const {
  const float of_tree = tree_.chance_of_placed(x, n, both_sides);
  return of_tree > 0 ? lerp(shares_at(x, n)[1] / of_tree, 1.0f, share_of_tree) : 1;
}

LearnedLights::Choice LearnedLights::choose(const Vec3& x, const Vec3& n, bool both_sides, float u,
                                            const Vec2& square) const {
  Choice c{{}, square};
  const float* shares = shares_at(x, n);
  if (u < share_of_tree) {
    c.light = tree_.choose(x, n, both_sides, u / share_of_tree);
    if (c.light.pmf == 0) return c;
    if (slots_[c.light.primitive] < 0) {
      c.light.pmf *= factor_of_placed(x, n, both_sides);
      return c;
    }
  } else {
    const float t = std::min((u - share_of_tree) / (1 - share_of_tree), one_minus_epsilon);
    const auto b = uint32_t(std::upper_bound(shares + 1, shares + blocks_, t) - shares - 1);
    if (b == 0) {
      c.light = tree_.choose_placed(x, n, both_sides,
                                    std::min(t / std::max(shares[1], 1e-30f), one_minus_epsilon));
      c.light.pmf *= factor_of_placed(x, n, both_sides);
      return c;
    }
    const auto after = std::upper_bound(parts_.begin(), parts_.end(), b,
                                        [](uint32_t k, const Part& p) { return k < p.first; });
    const Part& part = *(after - 1);
    const uint32_t k = b - part.first;
    const float side = float(part.side);
    const auto within = [side](uint32_t i, float f) {
      return std::min((float(i) + f) / side, one_minus_epsilon);
    };
    c.square = {within(k % part.side, square.x), within(k / part.side, square.y)};
    c.light.primitive = part.primitive;
  }
  const Part& part = part_of(c.light.primitive);
  c.light.pmf = pmf_of_block(shares, x, n, both_sides, part, c.square);
  return c;
}

}  // namespace troffer
