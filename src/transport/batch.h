// Plain arrays that the renderer passes to integrators and gets back: viewing rays or sensors go
// in, radiance or irradiance comes out. Used by every integrator and by render/. Lengths are in
// metres. Radiance and irradiance are linear RGB in the scene's units.
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

// n viewing rays; those of one pixel are adjacent.
struct ViewingRays {
  std::vector<Ray> rays;
  std::vector<uint64_t> streams;  // random stream of the ray's pixel
  std::vector<uint32_t> samples;  // sample number within that pixel
  std::vector<PixelAt> pixels;    // pixel in the picture; empty if there is no picture
  std::vector<Vec2> places;       // position within that pixel, [0,1)²; empty if `pixels` is
  // Empty, or per ray the shadow records of neighbouring rays. Only methods that compare patterns
  // use them.
  std::vector<NeighbourRecords> neighbours;

  // Kept by clear():
  RayCone cone;           // footprint of each ray, about a pixel wide
  SampleRequest request;  // request for all rays

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

// Points whose irradiance is to be estimated, as arrays of one length.
struct SensorBatch {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  // unit vectors
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  float offset = 0;  // distance of ray origins from the points along the normals, metres
  // Light straight from sources is computed only for every samples_per_direct-th sample, and
  // weighted by that factor. Its sample number is then samples[i] / samples_per_direct. Path
  // tracing does not compute direct light separately and ignores it.
  uint32_t samples_per_direct = 1;
  size_t size() const { return positions.size(); }
};

// Radiance of a viewing ray that is known before any light is sampled: emission of the first
// surface and an approximation of its reflected light. Deterministic for a given ray.
struct KnownRadiance {
  Rgb direct, indirect;
};

// Result of n viewing rays. direct + indirect is the radiance that arrives along the ray. `direct`
// is the light that reaches the first surface straight from sources, and emission. Mirrors and
// clear glass do not count as surfaces here.
struct RadianceBatch {
  std::vector<Rgb> direct, indirect;
  // Part of a sensor's `indirect` light that reaches it by way of flat mirrors and was computed
  // together with `direct`. Empty unless SensorBatch::samples_per_direct is above 1.
  std::vector<Rgb> images;
  std::vector<uint32_t> shadow_rays;
  // Variance of a sample's luminance due to the sampling of sources and to gather rays of its own.
  // Empty if the method does not estimate it.
  std::vector<float> direct_variance;
  // Standard error of the luminance of `indirect` from the fit. The samples of a pixel share it, so
  // averaging does not reduce it. Empty if the method does not estimate it.
  std::vector<float> shared_error;
  // A signed random draw of the error that the noise of cells causes in the luminance of
  // `indirect`. Draws of several samples are added with their signs, since samples that read the
  // same cells err alike. Empty if the method does not estimate it.
  std::vector<float> drawn_error;
  // Defined so that luminance(indirect) - luminance_with_error is the luminance of all light
  // without an error estimate; the film takes the error of that light from the spread of samples.
  // It is the luminance of `indirect` light that has an estimate, minus that of `direct` light that
  // has none (emission that a ray of a glossy lobe has hit). Empty if the method estimates no
  // errors.
  std::vector<float> luminance_with_error;
  // Properties of the first surface hit; zero if nothing is hit.
  std::vector<Rgb> albedo;
  std::vector<Vec3> normal, position;
  std::vector<uint8_t> is_hit;
  // Numbers of sources at the first surface by treatment, as in Aov::sources.
  std::vector<Rgb> sources;
  // Empty unless the caller resizes it to n (methods that compare patterns).
  std::vector<ShadowRecord> records;
  // Empty unless the caller resizes it to n (Integrator::has_surrogates).
  std::vector<KnownRadiance> known;
  // Correction that has been added to `direct` and `known` to remove the noise of visible lamps'
  // edges. Its mean over a pixel is 0. Empty if there is none (LightOutlines).
  std::vector<Rgb> edge_correction;
  // Largest contribution of a single sampled source point to the luminance of `direct`; 0 if none
  // was sampled. It gives a lower bound of the error: if by chance no sample was occluded, the
  // samples do not differ, although their mean may be too large.
  float largest_draw = 0;
  // Random draws of the error that the noise of cells causes in the luminance of `indirect`, summed
  // over all entries. All samples read the same cells, so more samples do not reduce it. 0 if the
  // method does not estimate it.
  NoiseDraws noise{};
  void reset(size_t n) {
    direct.assign(n, Rgb{0});
    indirect.assign(n, Rgb{0});
    images.clear();
    shadow_rays.assign(n, 0);
    direct_variance.clear();
    shared_error.clear();
    drawn_error.clear();
    luminance_with_error.clear();
    albedo.assign(n, Rgb{0});
    normal.assign(n, Vec3{});
    position.assign(n, Vec3{});
    is_hit.assign(n, 0);
    sources.assign(n, Rgb{0});
    records.clear();
    known.clear();
    edge_correction.clear();
    largest_draw = 0;
    noise = {};
  }
  // Arrays of error estimates, for methods that provide them.
  void enable_shared_error() {
    shared_error.resize(direct.size(), 0);
    drawn_error.resize(direct.size(), 0);
    luminance_with_error.resize(direct.size(), 0);
  }
  void enable_variance() { direct_variance.assign(direct.size(), 0); }
  void add(size_t i, bool is_direct, Rgb light, float variance) {
    (is_direct ? direct : indirect)[i] += light;
    if (is_direct && !direct_variance.empty()) direct_variance[i] += variance;
  }
  // Records the luminance that one sampled point of a source contributes.
  void note_draw(bool is_direct, float luminance) {
    if (is_direct) largest_draw = std::max(largest_draw, luminance);
  }
  // Marks direct light of this luminance as light without an estimated variance. With
  // luminance_with_error, the film uses the spread of samples for it. Otherwise the square of the
  // luminance is added to direct_variance, since the mean square bounds the variance of a sample.
  void exclude_from_error(size_t i, float luminance) {
    if (!luminance_with_error.empty())
      luminance_with_error[i] -= luminance;
    else if (!direct_variance.empty())
      direct_variance[i] += luminance * luminance;
  }
};

// Counts of work done; += adds those of another batch.
struct Counters {
  uint64_t viewing_rays = 0;
  uint64_t surrogates = 0;      // viewing rays that only look up known radiance
  uint64_t extension_rays = 0;  // closest-hit rays after the viewing ray
  uint64_t shadow_rays = 0;
  uint64_t nan_samples = 0;
  // (hit, source) pairs by the way they were answered
  uint64_t lit_certified = 0, dark_certified = 0, masked = 0, mixed = 0;
  // Work of certificates: pairs of cluster and source, masks, facets in masks, and points at which
  // an integrand was evaluated.
  uint64_t clusters = 0, masks = 0, mask_facets = 0, points = 0;

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
    clusters += o.clusters;
    masks += o.masks;
    mask_facets += o.mask_facets;
    points += o.points;
    return *this;
  }
};

}  // namespace troffer
