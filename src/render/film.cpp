#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/ablation.h"
#include "render/aov_rows.h"
#include "transport/allowed_error.h"

namespace troffer {

namespace {

Vec3d as_vec(Rgb c) {
  return {double(c.r), double(c.g), double(c.b)};
}
Rgb as_rgb(const Vec3d& v) {
  return {float(v.x), float(v.y), float(v.z)};
}

// Returns the standard error of the mean of n values; 0 with fewer than two.
double error_of_mean(double sum, double squares, double n) {
  if (n < 2) return 0;
  const double mean = sum / n;
  return std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
}

bool needs_first_hit(Aov a) {
  return a == Aov::albedo || a == Aov::normal || a == Aov::depth || a == Aov::position ||
         a == Aov::shadow_rays || a == Aov::sources;
}

// Returns a black layer with the name and the channels that files use.
Layer empty_layer(Aov aov, const PixelRect& window) {
  const AovRow& row = row_of(aov);
  return {std::string(row.name),
          {row.channels.begin(), row.channels.end()},
          Image(window.width(), window.height())};
}

}  // namespace

double Film::bytes(double pixels, const std::vector<Aov>& aovs, bool has_surrogates) {
  const bool has_first_hits = std::any_of(aovs.begin(), aovs.end(), needs_first_hit);
  // Layers of the result exist together with the sums.
  return pixels * double(sizeof(Pixel) + (has_first_hits ? sizeof(FirstHit) : 0) +
                         (has_surrogates ? sizeof(Known) : 0) + sizeof(Rgb) * (1 + aovs.size()));
}

Film::Film(const PixelRect& window, const std::vector<Aov>& aovs, const Vec3d& origin)
    : window_(window),
      aovs_(aovs),
      origin_(origin),
      pixels_(size_t(window.width()) * size_t(window.height())) {
  if (std::any_of(aovs.begin(), aovs.end(), needs_first_hit)) first_hits_.resize(pixels_.size());
}

// Returns the standard error of the mean luminance, from the spread of the samples.
double Film::standard_error(const Pixel& p) {
  return error_of_mean(p.sum_luminance, p.sum_luminance_squared, p.samples);
}

// Uses the method's own error estimates if there are any. Independent errors of samples add in
// quadrature; shared ones add linearly. Light that the method does not cover, such as gloss,
// contributes the spread of its samples. Without estimates, the spread of all samples is used.
//
// For whole pictures, variance_beyond() adds what edges within the pixel contribute.
double Film::estimated_error(size_t i) const {
  const Pixel& p = pixels_[i];
  if (!p.has_source_variance)
    return standard_error(p) * std::pow(std::max(p.samples, 1u), -0.5 * evenness_);
  const double n = p.samples;
  double independent = independent_variance(p);
  if (p.has_whole_error) independent += variance_beyond(i, independent);
  return std::sqrt((independent + sqr(p.shared_error) + sqr(p.drawn_error)) / sqr(n) +
                   variance_of_surrogates(i));
}

// Returns the variance of a pixel's mean due to surrogate samples, which edges within the pixel
// cause. Blocks of them are stratified over the pixel, so n blocks err by n^-3/4.
double Film::variance_of_surrogates(size_t i) const {
  if (known_.empty()) return 0;
  const KnownSums& g = known_[i].surrogates;
  const double m = g.count, size = surrogates_of_block, blocks = std::floor(m / size);
  if (blocks < 2) return 0;
  const double mean = double(g.luminance) / blocks,
               of_block =
                   std::max(double(known_[i].squares_of_surrogate_blocks) / blocks - sqr(mean),
                            0.0) *
                   blocks / (blocks - 1) / sqr(size),
               share = m / (m + pixels_[i].samples);
  return sqr(share) * of_block / std::pow(blocks, 1.5);
}

// Returns the variance of a pixel's sum: the method's own estimate, plus the spread of the light
// that it does not cover.
double Film::independent_variance(const Pixel& p) {
  const double n = p.samples;
  return p.source_variance + sqr(error_of_mean(p.untold, p.without_error_squared, n) * n);
}

// Returns the variance of a pixel's sum beyond the independent one. Blocks of 4, 16 or 64 samples
// are stratified over as many squares of the pixel. At an edge, the variance of a block's mean is a
// half, a quarter or an eighth of that of independent samples. Features smaller than such a square
// keep all of it.
double Film::variance_beyond(size_t i, double independent) const {
  constexpr double gain_of_edges = 0.5;
  const double n = pixels_[i].samples;
  const double size = known_.empty() ? 1 : known_[i].block_size, blocks = std::floor(n / size);
  if (known_.empty() || blocks < 2) {
    const PixelEstimate e = estimate_of(i);
    const bool has_surrogates = !known_.empty() && known_[i].surrogates.count > 0;
    const double error = has_surrogates ? e.error_of_rest : e.standard_error;
    return (is_left_out<"gain of edges">() ? 1.0 : gain_of_edges) *
           std::max(sqr(error * n) - independent, 0.0);
  }
  const Known& k = known_[i];
  const double spread = sqr(error_of_mean(k.blocks, k.squares_of_blocks, blocks) * blocks);
  return std::max(spread * n / (blocks * size) - independent, 0.0);
}

PixelEstimate Film::estimate(int x, int y) const {
  return estimate_of(index(x, y));
}

PixelEstimate Film::estimate_of(size_t i) const {
  const Pixel& p = pixels_[i];
  PixelEstimate e;
  e.samples = p.samples;
  if (p.samples == 0) return e;
  e.luminance = e.rest = p.sum_luminance / p.samples;
  e.standard_error = e.error_of_rest = standard_error(p);
  e.independent_variance =
      p.has_whole_error ? independent_variance(p) / p.samples : sqr(e.standard_error) * p.samples;
  if (known_.empty()) return e;
  const Known& k = known_[i];
  const double n = p.samples;
  e.rest = double(k.rest) / n;
  e.error_of_rest = error_of_mean(k.rest, k.squares_of_rest, n);
  if (k.surrogates.count == 0) return e;
  const double of_surrogates =
      error_of_mean(k.surrogates.luminance, k.surrogates.squares, double(k.surrogates.count));
  // Known radiance comes from both kinds of samples.
  const double m = k.surrogates.count, share = m / (m + n);
  e.luminance += share * (double(k.surrogates.luminance) / m - double(k.samples.luminance) / n);
  e.standard_error = std::sqrt(sqr(e.error_of_rest) + sqr(of_surrogates) * share);
  return e;
}

Film::Light Film::light_of(size_t i) const {
  const Pixel& p = pixels_[i];
  if (p.samples == 0) return {};
  const double each = 1.0 / p.samples;
  const Light plain{p.direct * each, p.indirect * each};
  if (known_.empty()) return plain;
  // With few samples, the known radiance or the correction of lamp edges may exceed what they saw,
  // so the result would be negative. The plain mean of the samples replaces it then.
  const auto is_less = [](const Light& l) {
    const Vec3d sum = l.direct + l.indirect;
    return std::min({sum.x, sum.y, sum.z}) < 0;
  };
  const Light as_it_came{plain.direct - as_vec(known_[i].edge_correction) * each, plain.indirect};
  if (known_[i].surrogates.count == 0) return is_less(plain) ? as_it_came : plain;
  const auto &s = known_[i].samples, &g = known_[i].surrogates;
  const double each_surrogate = 1.0 / g.count,
               share = double(g.count) / (double(g.count) + p.samples);
  const Light light{
      plain.direct + (as_vec(g.direct) * each_surrogate - as_vec(s.direct) * each) * share,
      plain.indirect + (as_vec(g.indirect) * each_surrogate - as_vec(s.indirect) * each) * share};
  return is_less(light) ? as_it_came : light;
}

void Film::FirstHit::add(const RadianceBatch& batch, size_t i, float at_depth) {
  if (batch.is_hit[i] == 0) return;
  albedo += as_vec(batch.albedo[i]);
  normal += Vec3d(batch.normal[i]);
  position += Vec3d(batch.position[i]);
  depth += double(at_depth);
  ++hits;
}

void Film::FirstHit::forget_hits() {
  albedo = normal = position = {};
  depth = 0;
  hits = 0;
}

void Film::add_surrogate(int x, int y, const RadianceBatch& batch, size_t i, float depth) {
  const size_t at = index(x, y);
  if (!first_hits_.empty()) {
    if (known_[at].surrogates.count == 0) first_hits_[at].forget_hits();
    first_hits_[at].add(batch, i, depth);
  }
  known_[at].add_surrogate(batch.known[i]);
}

void Film::Known::add_surrogate(const KnownRadiance& seen) {
  surrogates.add(seen);
  surrogate_block += luminance(seen.direct + seen.indirect);
  if (surrogates.count % surrogates_of_block != 0) return;
  squares_of_surrogate_blocks += sqr(surrogate_block);
  surrogate_block = 0;
}

// so_far: number of samples, including this one.
void Film::Known::add_rest(float value, uint32_t so_far) {
  rest += value;
  squares_of_rest += value * value;
  block += value;
  if (so_far % block_size != 0) return;
  blocks += block;
  squares_of_blocks += block * block;
  block = 0;
}

void Film::expect_samples(int x, int y, uint32_t count) {
  constexpr uint32_t fewest_blocks = 4, largest = 64;
  const size_t i = index(x, y);
  if (known_.empty() || pixels_[i].samples > first_block_size) return;
  Known& k = known_[i];
  uint32_t size = first_block_size;
  while (size < largest && count >= 4 * size * fewest_blocks) size *= 4;
  if (size == k.block_size) return;
  k.block_size = size;
  k.block += k.blocks;
  k.blocks = k.squares_of_blocks = 0;
}

bool Film::add(int x, int y, const RadianceBatch& batch, size_t i, float depth) {
  const size_t at = index(x, y);
  Pixel& p = pixels_[at];
  ++p.samples;
  if (!first_hits_.empty()) {
    FirstHit& f = first_hits_[at];
    f.shadow_rays += batch.shadow_rays[i];
    f.sources += as_vec(batch.sources[i]);
    if (known_.empty() || known_[at].surrogates.count == 0) f.add(batch, i, depth);
  }
  const Rgb direct = batch.direct[i], indirect = batch.indirect[i];
  if (!is_finite(direct) || !is_finite(indirect)) return false;
  p.direct += as_vec(direct);
  p.indirect += as_vec(indirect);
  const double y_sample = double(luminance(direct + indirect));
  p.sum_luminance += y_sample;
  p.sum_luminance_squared += y_sample * y_sample;
  if (!known_.empty()) {
    Known& k = known_[at];
    k.samples.add(batch.known[i]);
    if (!batch.edge_correction.empty()) k.edge_correction += batch.edge_correction[i];
    const double rest =
        y_sample - double(luminance(batch.known[i].direct + batch.known[i].indirect));
    k.add_rest(float(rest), p.samples);
  }
  if (!batch.direct_variance.empty()) {
    p.source_variance += double(batch.direct_variance[i]);
    p.has_source_variance = true;
  }
  if (!batch.shared_error.empty()) p.shared_error += double(batch.shared_error[i]);
  if (!batch.drawn_error.empty()) p.drawn_error += double(batch.drawn_error[i]);
  if (!batch.luminance_with_error.empty()) {
    p.has_whole_error = true;
    const double untold = double(luminance(indirect)) - double(batch.luminance_with_error[i]);
    p.untold += untold;
    p.without_error_squared += untold * untold;
  }
  return true;
}

Layer Film::make_layer(Aov aov) const {
  Layer layer = empty_layer(aov, window_);
  const auto per_pixel = [&](auto&& value) {
    for (size_t i = 0; i < pixels_.size(); ++i) layer.image.pixels[i] = as_rgb(value(i));
  };
  const auto per_hit = [&](auto&& sum) {
    for (size_t i = 0; i < pixels_.size(); ++i)
      if (first_hits_[i].hits > 0)
        layer.image.pixels[i] = as_rgb(sum(first_hits_[i]) * (1.0 / first_hits_[i].hits));
  };
  switch (aov) {
    case Aov::direct:
      per_pixel([this](size_t i) { return light_of(i).direct; });
      break;
    case Aov::indirect:
      per_pixel([this](size_t i) { return light_of(i).indirect; });
      break;
    case Aov::albedo:
      per_hit([](const FirstHit& f) { return f.albedo; });
      break;
    case Aov::normal:
      per_hit([](const FirstHit& f) {
        const double l = length(f.normal);
        return l > 0 ? f.normal * (f.hits / l) : f.normal;
      });
      break;
    case Aov::position:
      per_hit([this](const FirstHit& f) { return f.position + origin_ * f.hits; });
      break;
    case Aov::depth:
      per_hit([](const FirstHit& f) { return Vec3d{f.depth}; });
      break;
    case Aov::shadow_rays:
      for (size_t i = 0; i < pixels_.size(); ++i)
        if (pixels_[i].samples > 0)
          layer.image.pixels[i] = Rgb{float(first_hits_[i].shadow_rays / pixels_[i].samples)};
      break;
    case Aov::sources:
      for (size_t i = 0; i < pixels_.size(); ++i)
        if (pixels_[i].samples > 0)
          layer.image.pixels[i] = as_rgb(first_hits_[i].sources * (1.0 / pixels_[i].samples));
      break;
    case Aov::error:
      for (size_t i = 0; i < pixels_.size(); ++i)
        layer.image.pixels[i] = Rgb{float(estimated_error(i))};
      break;
    case Aov::viewing_error:
      for (size_t i = 0; i < pixels_.size(); ++i)
        layer.image.pixels[i] = Rgb{float(estimate_of(i).standard_error)};
      break;
  }
  return layer;
}

std::optional<Rgb> Film::radiance(int x, int y) const {
  const size_t i = index(x, y);
  if (pixels_[i].samples == 0) return std::nullopt;
  const Light light = light_of(i);
  return as_rgb(light.direct + light.indirect);
}

std::vector<Layer> Film::layers() const {
  std::vector<Layer> layers(1);
  layers[0].image = Image(window_.width(), window_.height());
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Light light = light_of(i);
    layers[0].image.pixels[i] = as_rgb(light.direct + light.indirect);
  }
  for (const Aov a : aovs_) layers.push_back(make_layer(a));
  return layers;
}

double picture_error(const Film& film, const PixelRect& window) {
  std::vector<double> luminances, errors;
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      luminances.push_back(film.estimate(x, y).luminance);
      errors.push_back(film.estimated_error(x, y));
    }
  return picture_error(luminances, errors);
}

double picture_error(const std::vector<double>& luminances, const std::vector<double>& errors) {
  const double usual = usual_luminance(luminances);
  // A picture that is dark but for a twentieth has no usual luminance.
  const double white =
      usual > 0 ? white_luminance * usual : *std::max_element(luminances.begin(), luminances.end());
  if (!(white > 0)) return 0;
  double sum = 0, squares = 0;
  for (size_t i = 0; i < luminances.size(); ++i) {
    sum += std::min(luminances[i], white);
    squares += sqr(errors[i] * std::min(1.0, white / std::max(luminances[i], 1e-30)));
  }
  return std::sqrt(squares * double(luminances.size())) / sum;
}

}  // namespace troffer
