// Where around a picture's places it is far brighter than elsewhere: what a lamp in a cove shines
// on, a floor in the sun, a lit room behind a door that is ajar. Few of the rays that gather light
// by its cosine meet such a place, and those few bring most of the light. So some are aimed at it,
// and all count by the density of both kinds together: the sum has the same mean, whatever is aimed
// at, and no ray counts more than `1 / least_by_cosine` times.
//
// How many: the noise is least where rays are as dense as the root of the mean square of what they
// bring (Kahn & Marshall, "Methods of Reducing Sample Size in Monte Carlo Computations", 1953).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "cells/cell_hit.h"
#include "trace/tracer.h"

namespace troffer {

// What one ray met, of those that tell what a picture asks for.
struct PilotHit {
  CellHit hit;
  uint32_t cell = 0;
  float share = 0;   // what the picture asks it for, over all rays
  float weight = 0;  // luminance of the irradiance that it brings, over that of the cell
};

// A sphere around bright cells.
struct BrightPlace {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;            // mean of those of its surfaces: short where they are turned many ways
  float mean_square = 0;  // of the irradiance that a ray brings which meets them
};

// Where its cells were met.
struct BrightHits {
  static constexpr size_t most = 8;

  std::array<CellHit, most> hits;
  uint32_t count = 0;
};

// What about there is seen of all places.
struct BrightSight {
  std::vector<float> visible;  // of each, the share that is seen; over what is expected of it
  float rest = 0;              // mean square of the irradiance that other rays bring
};

class BrightPlaces {
 public:
  static constexpr size_t most_places = 128;
  static constexpr size_t most_tries = most_places * BrightHits::most;

  BrightPlaces() = default;
  // None where it is evenly bright. irradiance: of cells, of this size. The tracer must outlive it.
  BrightPlaces(const Tracer& tracer, std::vector<PilotHit> seen, std::span<const Rgb> irradiance,
               float cell_size);

  std::span<const BrightPlace> all() const { return places_; }
  // As known before any ray is sent. Of each place, how much of it is seen from some places on
  // average, of which a few are tried, by about so many rays in all.
  BrightSight sight_from(std::span<const CellHit> from, size_t rays = most_tries) const;

 private:
  const Tracer* tracer_ = nullptr;
  std::vector<BrightPlace> places_;
  std::vector<BrightHits> hits_;  // of each
  float rest_ = 0;
};

// How rays that gather light at one place are drawn.
class GatherAim {
 public:
  static constexpr float least_by_cosine = 0.5f;

  // By the cosine alone.
  GatherAim() = default;
  GatherAim(const BrightPlaces& places, std::span<const float> visible, float rest,
            const CellHit& at);
  GatherAim(const BrightPlaces& places, const BrightSight& sight, const CellHit& at)
      : GatherAim(places, sight.visible, sight.rest, at) {}

  // The direction of a ray, and what it counts, over one that is drawn by its cosine.
  Vec3 direction(const CellHit& at, Vec2 number, float& weight) const;
  // … with which it is drawn, per steradian.
  float density(const CellHit& at, const Vec3& direction) const;
  bool is_towards_bright(const Vec3& direction) const { return density_towards(direction) > 0; }
  // Mean over rays by cosine of the square of what those bring that are towards bright places.
  float expected() const { return expected_; }

 private:
  struct Cone {
    Frame frame;
    float height = 0;   // 1 - cosine of its half angle
    float share = 0;    // of rays
    float density = 0;  // of those, per steradian, all rays being 1
  };

  float density_towards(const Vec3& direction) const;

  float by_cosine_ = 1, expected_ = 0;
  std::vector<Cone> cones_;
};

// What the first rays from about there have brought, for those that come later. They are drawn by
// it, but do not count it: so their mean stays what it is.
class BrightTally {
 public:
  // irradiance: the luminance that a ray brought, weight included.
  void add(const GatherAim& aim, const Vec3& direction, float weight, float irradiance);
  void tell(BrightSight& sight) const;

 private:
  double rest_ = 0, rest_rays_ = 0, bright_ = 0, expected_ = 0;
};

}  // namespace troffer
