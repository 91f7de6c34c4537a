#include "import/weld.h"

#include <array>
#include <bit>
#include <cstdint>

#include "base/parallel.h"
#include "base/random.h"

namespace troffer {

namespace {

constexpr size_t weld_piece = size_t(3) << 15, weld_buckets = 256;
constexpr uint32_t no_corner = 0xffffffffu;

uint64_t hash_of_place(const Vec3& p) {
  // -0 becomes 0
  const auto bits = [](float x) { return uint64_t(std::bit_cast<uint32_t>(x + 0.0f)); };
  return mix64((bits(p.x) | bits(p.y) << 32) ^ mix64(bits(p.z)));
}

size_t bucket_of(const Vec3& p) {
  return size_t(hash_of_place(p) >> 56);
}

// Corners grouped by buckets of their positions, in order within each bucket.
struct Sorted {
  std::vector<uint32_t> corners;
  std::array<size_t, weld_buckets + 1> begin{};
};

Sorted sorted(const std::vector<Vec3>& corners) {
  const size_t pieces = corners.size() / weld_piece + 1;
  std::vector<std::array<size_t, weld_buckets>> at(pieces);  // counts, then next positions
  parallel_pieces(corners.size(), weld_piece, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) ++at[begin / weld_piece][bucket_of(corners[i])];
  });
  Sorted result;
  size_t sum = 0;
  for (size_t b = 0; b < weld_buckets; ++b) {
    result.begin[b] = sum;
    for (auto& of_piece : at) {
      const size_t count = of_piece[b];
      of_piece[b] = sum;
      sum += count;
    }
  }
  result.begin[weld_buckets] = sum;
  result.corners.resize(corners.size());
  parallel_pieces(corners.size(), weld_piece, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      result.corners[at[begin / weld_piece][bucket_of(corners[i])]++] = uint32_t(i);
  });
  return result;
}

// Sets, for the corners of one bucket, the first corner at the same position (perhaps itself).
void find_firsts(const std::vector<Vec3>& corners, const uint32_t* begin, const uint32_t* end,
                 std::vector<uint32_t>& firsts) {
  std::vector<uint32_t> table(std::bit_ceil(size_t(end - begin) * 2 + 1), no_corner);
  const size_t mask = table.size() - 1;
  for (const uint32_t* i = begin; i != end; ++i) {
    const Vec3& p = corners[*i];
    firsts[*i] = *i;
    if (!is_finite(p)) continue;
    size_t slot = hash_of_place(p) & mask;
    while (table[slot] != no_corner && !(corners[table[slot]] == p)) slot = (slot + 1) & mask;
    if (table[slot] == no_corner)
      table[slot] = *i;
    else
      firsts[*i] = table[slot];
  }
}

}  // namespace

Mesh weld(const std::vector<Vec3>& corners, const TellProgress& tell, double first) {
  const size_t n = corners.size() / 3 * 3;
  Sorted order = sorted(corners);
  std::vector<uint32_t> firsts(corners.size());
  ReadProgress progress(tell, first, 1, weld_buckets);
  parallel_for(weld_buckets, 0, [&](size_t b) {
    const uint32_t* const all = order.corners.data();
    find_firsts(corners, all + order.begin[b], all + order.begin[b + 1], firsts);
    progress.add(1);
  });
  std::vector<uint32_t> numbers = std::move(order.corners);  // vertex numbers of first corners
  std::vector<size_t> counts(n / weld_piece + 2);            // vertices before each weld_piece
  parallel_pieces(n, weld_piece, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) counts[begin / weld_piece + 1] += firsts[i] == i ? 1 : 0;
  });
  for (size_t k = 1; k < counts.size(); ++k) counts[k] += counts[k - 1];
  Mesh mesh;
  mesh.positions.resize(counts.back());
  mesh.triangles.resize(n / 3);
  parallel_pieces(n, weld_piece, [&](size_t begin, size_t end) {
    size_t number = counts[begin / weld_piece];
    for (size_t i = begin; i < end; ++i) {
      if (firsts[i] != i) continue;
      mesh.positions[number] = corners[i];
      numbers[i] = uint32_t(number++);
    }
  });
  parallel_pieces(n, weld_piece, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) mesh.triangles[i / 3][i % 3] = numbers[firsts[i]];
  });
  return mesh;
}

}  // namespace troffer
