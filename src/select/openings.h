// Openings through which a sky or an environment lights a room, learned from light samples. Without
// them, most samples of a sky seen through windows are blocked by walls.
//
// Light samples of receivers whose sky is mostly blocked leave the bounding box of these receivers
// through its faces, which are divided into cells. The mean radiance that came in through cells
// makes them rectangular lamps. A
// light tree chooses among these lamps for a receiver, and a direction is sampled towards the lamp
// by solid angle, as for portals placed by hand [1]. Choices are mixed with those of the light's
// own table, so estimates remain unbiased whatever the samples missed.
//
// References: [1] Bitterli, Novák & Jarosz, "Portal-Masked Environment Map Sampling", EGSR 2015.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "light/light_primitive.h"
#include "scene/scene.h"
#include "select/light_tree.h"

namespace troffer {

// A sample of a light at infinity.
struct SkySample {
  Vec3 position, direction;  // of the receiver; unit, towards the sky
  float inverse_pdf = 0;     // sr
  float light = 0;           // luminance that arrives; 0: blocked
};

// Immutable; any number of threads may call it.
class Openings {
 public:
  // Share of light samples that openings choose for receivers in the box. What they miss keeps the
  // rest, so its standard deviation at most doubles.
  static constexpr float share = 0.75f;

  // piece: index of the light piece that the samples are of.
  Openings(uint32_t piece, std::vector<SkySample> samples);
  Openings(const Openings&) = delete;
  Openings& operator=(const Openings&) = delete;

  uint32_t piece() const { return piece_; }
  bool is_empty() const { return tree_.is_empty(); }
  // True if openings choose directions for a receiver at x.
  bool contains(const Vec3& x) const;
  // Samples a direction for a receiver in the box at x with unit normal n, by u and numbers, all
  // uniform. both_sides: light from behind n counts too. Returns false if none was found.
  bool sample(const Vec3& x, const Vec3& n, bool both_sides, float u, const Vec2& numbers,
              Vec3& direction) const;
  // Density per steradian with which sample() finds a direction.
  float pdf(const Vec3& x, const Vec3& n, bool both_sides, const Vec3& direction) const;

 private:
  struct Exit {
    uint32_t cell;
    float distance;
  };
  Exit exit_of(const Vec3& x, const Vec3& direction) const;
  std::vector<float> mean_radiance(const std::vector<SkySample>& samples) const;
  void add_lamp(uint32_t first, std::vector<float>& radiance);
  Vec3 corner(uint32_t face, uint32_t k, uint32_t l) const;

  uint32_t piece_;
  Box box_;
  Scene lamps_;  // rectangles of cells that light came in through
  std::vector<int32_t> lamp_of_cell_;
  LightPrimitives primitives_;
  LightTree tree_;
};

}  // namespace troffer
