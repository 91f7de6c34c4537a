// The plain arrays that flow through the renderer: viewing rays of a tile in, radiance out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "cells/noise_draws.h"
#include "trace/ray.h"
#include "transport/sample_request.h"
#include "transport/shadow_record.h"

namespace troffer {

struct PixelAt {
  int32_t x = 0, y = 0;
};

// n viewing rays, those of a pixel side by side.
struct ViewingRays {
  std::vector<Ray> rays;
  std::vector<uint64_t> streams;  // names the random numbers of the ray's pixel
  std::vector<uint32_t> samples;  // which sample of that pixel
  std::vector<PixelAt> pixels;    // where in the picture; empty: no picture is known
  std::vector<Vec2> places;       // … and in that pixel, [0,1)²; empty likewise
  // Empty, or for each ray what is known of the rays around it (methods that compare patterns).
  std::vector<NeighbourRecords> neighbours;

  // Kept by clear():
  RayCone cone;           // of each ray, about a pixel wide
  SampleRequest request;  // of all rays

  size_t size() const { return rays.size(); }
  void clear() {
    rays.clear();
    streams.clear();
    samples.clear();
    pixels.clear();
    places.clear();
    neighbours.clear();
  }
};

// Points whose irradiance is asked for, as plain arrays of one length.
struct SensorBatch {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  // unit
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  float offset = 0;  // metres off the points, along their normals, at which rays start
  // Light straight from sources is asked for at every so many-th sample alone, as sample number
  // samples[i] / samples_per_direct of it, and counts so many times there (methods that compute it
  // apart).
  uint32_t samples_per_direct = 1;
  size_t size() const { return positions.size(); }
};

// What is known of a viewing ray's radiance before any light is sampled for it: what the first
// surface emits, and about what it reflects. The same for the same ray, however it is asked.
struct KnownRadiance {
  Rgb direct, indirect;
};

// What n viewing rays bring back. direct + indirect is the radiance that arrives along the ray;
// direct is the part that reaches the first surface, as seen by way of mirrors and clear glass,
// straight from sources, and the sources themselves.
struct RadianceBatch {
  std::vector<Rgb> direct, indirect;
  // What of a sensor's `indirect` light mirrors bring straight from sources, asked for with
  // `direct`; empty where nothing is asked for apart (SensorBatch::samples_per_direct).
  std::vector<Rgb> images;
  std::vector<uint32_t> shadow_rays;
  // Variance of the luminance of `direct` by the sampling of sources; empty where the method does
  // not tell.
  std::vector<float> direct_variance;
  // What the luminance of `indirect` may be off by and all samples of a pixel share: standard
  // errors. Empty where the method does not tell.
  std::vector<float> shared_error;
  // … and one draw, of either sign, of what it is off by besides: that of samples is that of their
  // sum. Empty likewise.
  std::vector<float> drawn_error;
  // Luminance of that part of `indirect` whose error is told by either of these, less that of the
  // part of `direct` whose is not (what a lobe's own ray has met): how far the rest is off, samples
  // tell by how far they differ. Empty where nothing is told.
  std::vector<float> indirect_with_error;
  // The first surface hit; zero where nothing is.
  std::vector<Rgb> albedo;
  std::vector<Vec3> normal, position;
  std::vector<uint8_t> is_hit;
  // How many sources were treated there: sampled by shadow rays; probed, visible as it seems;
  // probed, hidden as it seems.
  std::vector<Rgb> sources;
  // Empty unless asked for by resizing it to n (methods that compare patterns).
  std::vector<ShadowRecord> records;
  // Empty unless asked for by resizing it to n (Integrator::has_surrogates).
  std::vector<KnownRadiance> known;
  // Empty, or what has been added to `direct` and `known`, 0 in the mean over a pixel: to even out
  // what lamps send to it.
  std::vector<Rgb> evened;
  // Luminance of `direct` that the weightiest of all open points drawn of sources brought, 0 where
  // none did: samples that happen to find all of them open differ by nothing.
  float largest_draw = 0;
  // Draws of what the luminance of `indirect`, summed over all, is off by and no number of samples
  // brings down; 0 where the method knows nothing of it.
  NoiseDraws noise{};
  void reset(size_t n) {
    direct.assign(n, Rgb{0});
    indirect.assign(n, Rgb{0});
    images.clear();
    shadow_rays.assign(n, 0);
    direct_variance.clear();
    shared_error.clear();
    drawn_error.clear();
    indirect_with_error.clear();
    albedo.assign(n, Rgb{0});
    normal.assign(n, Vec3{});
    position.assign(n, Vec3{});
    is_hit.assign(n, 0);
    sources.assign(n, Rgb{0});
    records.clear();
    known.clear();
    evened.clear();
    largest_draw = 0;
    noise = {};
  }
  // For methods that tell the variance: light along viewing ray i, and what its luminance's is.
  void enable_shared_error() {
    shared_error.resize(direct.size(), 0);
    drawn_error.resize(direct.size(), 0);
    indirect_with_error.resize(direct.size(), 0);
  }
  void enable_variance() { direct_variance.assign(direct.size(), 0); }
  void add(size_t i, bool is_direct, Rgb light, float variance) {
    (is_direct ? direct : indirect)[i] += light;
    if (is_direct && !direct_variance.empty()) direct_variance[i] += variance;
  }
  // A point drawn of a source has brought so much.
  void note_draw(bool is_direct, float luminance) {
    if (is_direct) largest_draw = std::max(largest_draw, luminance);
  }
  // Of light that was added as direct. Where samples are not asked, the variance of one of them is
  // no more than the mean of its square.
  void exclude_from_error(size_t i, float luminance) {
    if (!indirect_with_error.empty())
      indirect_with_error[i] -= luminance;
    else if (!direct_variance.empty())
      direct_variance[i] += luminance * luminance;
  }
};

// Counts of work done; those of all batches are added up.
struct Counters {
  uint64_t viewing_rays = 0;
  uint64_t surrogates = 0;      // viewing rays that look up what is known, and ask no source
  uint64_t extension_rays = 0;  // closest-hit rays after the viewing ray
  uint64_t shadow_rays = 0;
  uint64_t nan_samples = 0;
  // (hit, source) pairs by how they were answered
  uint64_t lit_certified = 0, dark_certified = 0, masked = 0, mixed = 0;

  Counters& operator+=(const Counters& o) {
    viewing_rays += o.viewing_rays;
    surrogates += o.surrogates;
    extension_rays += o.extension_rays;
    shadow_rays += o.shadow_rays;
    nan_samples += o.nan_samples;
    lit_certified += o.lit_certified;
    dark_certified += o.dark_certified;
    masked += o.masked;
    mixed += o.mixed;
    return *this;
  }
};

}  // namespace troffer
