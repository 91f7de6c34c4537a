// Random occluders in front of ceiling_source().
#pragma once

#include <vector>

#include "base/random.h"
#include "brute_force.h"

namespace troffer::test {

// Returns a direction within about 17 degrees of level.
inline Vec3 levelish(Random& random) {
  for (;;) {
    const Vec3 d{2 * random.next_float() - 1, 2 * random.next_float() - 1,
                 0.3f * (2 * random.next_float() - 1)};
    if (length(d) > 0.1f && length(d) < 1) return normalize(d);
  }
}

inline Vec3 before_source(Random& random, float lower, float upper) {
  const float x = random.next_float() - 0.5f, y = random.next_float() - 0.5f;
  return {0.9f * x, 0.9f * y, lower + (upper - lower) * random.next_float()};
}

// Returns flat wires of 2 m, parallel or in random directions.
inline std::vector<Quad> wires(Random& random, int n, float half_width, bool are_parallel = false) {
  std::vector<Quad> out;
  Vec3 way = levelish(random);
  for (int i = 0; i < n; ++i) {
    if (!are_parallel) way = levelish(random);
    const Vec3 middle = before_source(random, 0.8f, 1.6f);
    const Vec3 side = normalize(cross(way, Vec3{0, 0, 1})) * half_width;
    const Vec3 a = middle - way, b = middle + way;
    out.push_back({a - side, b - side, b + side, a + side});
  }
  return out;
}

inline std::vector<Quad> leaves(Random& random, int n, float size) {
  std::vector<Quad> out;
  for (int i = 0; i < n; ++i) {
    const Vec3 middle = before_source(random, 0.5f, 1.6f), u = levelish(random);
    const Vec3 other{random.next_float(), random.next_float(), 1};
    out.push_back(parallelogram_facet(middle, u * size, normalize(cross(u, other)) * size));
  }
  return out;
}

// Returns hanging flat wires, within about 4 degrees of upright.
inline std::vector<Quad> curtain(Random& random, int n, float width) {
  std::vector<Quad> out;
  const auto off = [&] {
    return 0.1f * (random.next_float() + random.next_float() + random.next_float() - 1.5f);
  };
  for (int i = 0; i < n; ++i) {
    const float x = 3 * random.next_float() - 1.5f, y = 0.5f * random.next_float() - 0.25f;
    const float turn = 6.28f * random.next_float(), to_x = off(), to_y = off();
    out.push_back(parallelogram_facet({x, y, 0.4f}, Vec3{std::cos(turn), std::sin(turn), 0} * width,
                                      {to_x, to_y, 1.5f}));
  }
  return out;
}

// Returns n strips of `width`, `step` apart, rotated by `angle` from the source's second side.
inline std::vector<Quad> slats(Random& random, int n, float step, float width, float angle) {
  std::vector<Quad> out;
  const Vec3 way{-std::sin(angle), std::cos(angle), 0}, across{std::cos(angle), std::sin(angle), 0};
  const Vec3 first = across * (step * (random.next_float() - 0.5f * float(n)));
  const float z = 0.8f + 0.8f * random.next_float();
  for (int i = 0; i < n; ++i)
    out.push_back(parallelogram_facet(first + across * (step * float(i)) - way * 3 + Vec3{0, 0, z},
                                      across * width, way * 6));
  return out;
}

// Returns a facet that covers everything on one side of a random line.
inline Quad half_plane(Random& random) {
  const Vec3 way = levelish(random), p = before_source(random, 1, 1.2f);
  return parallelogram_facet(p - way * 3, way * 6, normalize(cross(way, Vec3{0, 0, 1})) * 3);
}

}  // namespace troffer::test
