// Linear fits over the gathers of neighbouring records: the irradiance at each record, its
// estimated error, and how many further rays a record needs. Used by GatherPass (gather_pass.h),
// record by record and in any order. References: docs/method/cells-appendix.md, "Final gather".
#pragma once

#include <vector>

#include "cells/linear_fit.h"
#include "gather/gather_records.h"

namespace troffer {

class GatherFits {
 public:
  static constexpr int most_pixels = 16;  // radius of a fit
  static constexpr int usual_pixels = 5;  // radius of usual_rays()
  static constexpr uint32_t first_rays = 8,
                            most_rays = 512;  // smallest and largest number for a record
  // Radius within which light is nearly linear, in harmonic mean distances.
  static constexpr float near_radius = 0.06f;

  // One of a record's two sums: irradiance or gloss.
  using Part = GatherSums GatherRecord::*;
  // Means over the records around one.
  struct Surroundings {
    float nearness = 0;  // mean of 1 / distance, 1/m
    float variance = 0;  // variance of a gather of 16 rays, by the spread of rays
    float records = 0;   // number of records averaged
  };

  // The arguments must outlive this object. is_thinned: records may be missing at pixels off the
  // lattice.
  GatherFits(const GatherRecords& records, const GatherOptions& options, bool is_thinned)
      : records_(records), options_(options), is_thinned_(is_thinned) {}

  // The lattice on which thinned pictures keep all records: every second pixel of every second row.
  static bool is_on_lattice(int x, int y) { return ((x | y) & 1) == 0; }

  // Values per record that fits read. The caller sets all of them by the functions of the same
  // names before it calls what depends on them: surroundings and fits.
  std::vector<uint8_t>& behind_edge() { return behind_edge_; }
  std::vector<float>& usual_rays() { return usual_rays_; }

  bool is_behind_edge(int x, int y, uint32_t r) const;
  float usual_rays(int x, int y, uint32_t r) const;
  bool is_neighbour(uint32_t at, uint32_t other, Part part) const;
  Surroundings around(int x, int y, uint32_t r, Part part) const {
    return around(x, y, r, part, Asked::all);
  }
  // Returns the number of rays that record r needs besides its first ones.
  uint32_t further_rays(int x, int y, uint32_t r) const;
  FittedRecord fitted(int x, int y, uint32_t r) const;

 private:
  // Fit of one sum.
  struct Fitted {
    Rgb value;
    float error = 0;  // estimated error of the luminance of `value`
  };
  // Choice of the records around one that are read.
  enum class Asked : uint8_t { all, other_half };

  Surroundings around(int x, int y, uint32_t r, Part part, Asked asked) const;
  int step_of(int x, int y, int step) const;
  LinearFit fit(int x, int y, uint32_t r, Part part, float radius, int along,
                Asked asked = Asked::all) const;
  static FittedLight solved(const LinearFit& fit, const Surroundings& s);
  float allowed_error(const GatherRecord& r, Part part, float around) const;
  uint32_t further_rays(int x, int y, uint32_t r, Part part) const;
  float fit_part(int x, int y, uint32_t r, Part part, Fitted& fitted) const;
  float own_rays(int x, int y, uint32_t r, Part part) const;

  const GatherRecords& records_;
  const GatherOptions& options_;
  bool is_thinned_;
  std::vector<uint8_t> behind_edge_;  // per record: is_behind_edge()
  std::vector<float> usual_rays_;     // per record: usual_rays()
};

}  // namespace troffer
