#include "import/tensor_tree.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/parallel.h"
#include "base/warp.h"

namespace troffer {

namespace {

constexpr int most_levels = 12;  // 4096 cells along an axis

void skip_blanks(const char*& at, const char* end) {
  while (at < end && (std::isspace(static_cast<unsigned char>(*at)) || *at == ',')) ++at;
}

}  // namespace

TensorTree::TensorTree(const std::string& text, int dimensions, std::string& problem)
    : dimensions_(dimensions) {
  const char *at = text.data(), *end = at + text.size();
  problem.clear();
  if (!parse(at, end, 0, root_, problem)) return;
  skip_blanks(at, end);
  if (at != end) problem = "has characters after its tensor tree";
}

bool TensorTree::parse(const char*& at, const char* end, int level, Node& node,
                       std::string& problem) {
  skip_blanks(at, end);
  if (level > most_levels) problem = "has a tensor tree of more than 12 levels";
  if (problem.empty() && (at == end || *at != '{')) problem = "lacks a '{' of its tensor tree";
  if (!problem.empty()) return false;
  ++at;
  skip_blanks(at, end);
  if (at < end && *at == '{') {
    node.branches.resize(size_t(1) << dimensions_);
    for (Node& branch : node.branches)
      if (!parse(at, end, level + 1, branch, problem)) return false;
  } else if (!parse_values(at, end, level, node, problem)) {
    return false;
  }
  skip_blanks(at, end);
  if (at == end || *at != '}') {
    problem = "lacks a '}' of its tensor tree";
    return false;
  }
  ++at;
  return true;
}

bool TensorTree::parse_values(const char*& at, const char* end, int level, Node& node,
                              std::string& problem) {
  while (true) {
    skip_blanks(at, end);
    float v = 0;
    const auto read = std::from_chars(at, end, v);
    if (read.ec != std::errc() || !std::isfinite(v)) break;
    at = read.ptr;
    node.values.push_back(std::max(v, 0.0f));
  }
  for (int side = 0; level + side <= most_levels; ++side)
    if (node.values.size() == size_t(1) << (side * dimensions_)) {
      node.log2_side = side;
      depth_ = std::max(depth_, level + side);
      return true;
    }
  problem = "has a tensor tree with " + std::to_string(node.values.size()) +
            " values at a place, which fill no grid";
  return false;
}

float TensorTree::value(std::array<double, 4> position) const {
  const auto n = size_t(dimensions_);
  const Node* node = &root_;
  while (!node->branches.empty()) {
    size_t branch = 0;
    for (size_t d = 0; d < n; ++d) {
      position[d] *= 2;
      if (position[d] < 1) continue;
      position[d] -= 1;
      branch |= size_t(1) << d;
    }
    node = &node->branches[branch];
  }
  size_t at = 0;
  const double side = double(size_t(1) << node->log2_side);
  for (size_t d = 0; d < n; ++d)
    at = (at << node->log2_side) + size_t(std::clamp(position[d] * side, 0.0, side - 1));
  return node->values[at];
}

// Isotropic trees hold the sine of incidence, falling from 1/2 at the normal, and the leaving
// direction with the incident light's azimuth turned to 0.
float TensorTree::value(const Vec3& in, const Vec3& out) const {
  const Vec2T<double> along{-double(in.x), -double(in.y)}, to{double(out.x), double(out.y)};
  if (dimensions_ == 4) {
    const auto a = square_from_disk(along), b = square_from_disk(to);
    return value({a.x, a.y, b.x, b.y});
  }
  const double sine = std::hypot(along.x, along.y);
  const double c = sine > 0 ? along.x / sine : 1, s = sine > 0 ? along.y / sine : 0;
  const auto b = square_from_disk(Vec2T<double>{to.x * c + to.y * s, to.y * c - to.x * s});
  return value({std::clamp(0.5 - 0.5 * sine, 0.0, 0.499999), b.x, b.y, 0});
}

namespace {

// Directions at the middles of the cells of a square, and their patches.
struct Leaving {
  std::vector<Vec3> directions;
  std::vector<size_t> patches;

  Leaving(const AngleBasis& basis, int side) {
    for (int k = 0; k < side * side; ++k) {
      const Vec2 d = disk_from_square(
          Vec2{(float(k % side) + 0.5f) / float(side), (float(k / side) + 0.5f) / float(side)});
      directions.emplace_back(d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y)));
      patches.push_back(basis.patch_of(directions.back()));
    }
  }
};

}  // namespace

AngleMatrix TensorTree::reduced_to(const AngleBasis& basis) const {
  constexpr int steps = 2;  // directions of incidence along each side of a patch
  const Leaving leaving(basis, 1 << std::clamp(depth_, 7, 8));
  AngleMatrix m{basis, basis, {}};
  m.values.resize(basis.size() * basis.size());
  parallel_for(basis.size(), 0, [&](size_t i) {
    std::vector<double> sums(basis.size()), counts(basis.size());
    for (int s = 0; s < steps * steps; ++s) {
      const Vec3 w = basis.direction(
          i, {(float(s % steps) + 0.5f) / float(steps), (float(s / steps) + 0.5f) / float(steps)});
      for (size_t k = 0; k < leaving.directions.size(); ++k) {
        const size_t o = leaving.patches[k];
        sums[o] += double(value({-w.x, -w.y, w.z}, leaving.directions[k]));
        counts[o] += 1;
      }
    }
    for (size_t o = 0; o < basis.size(); ++o)
      m.values[o * basis.size() + i] = float(counts[o] > 0 ? sums[o] / counts[o] : 0);
  });
  return m;
}

}  // namespace troffer
