#include "render/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/ablation.h"
#include "base/units.h"
#include "render/sample_spread.h"
#include "transport/allowed_error.h"

namespace troffer {

namespace {

// Least number of samples of a pixel with the outline of a lamp of unknown coverage: surrogates,
// and paths where there are none. Of 1024 paths, ten meet a lamp that covers a hundredth of the
// pixel.
constexpr double least_with_lamp = 256, least_paths_with_lamp = 1024;
constexpr std::array<std::pair<int, int>, 4> neighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

bool is_inside(const PixelRect& w, int x, int y) {
  return x >= w.x0 && y >= w.y0 && x < w.x1 && y < w.y1;
}

// Stored form of a record, without padding between members.
struct RecordBytes {
  uint32_t geometry, flags;
  Vec3 normal, position;
  uint32_t patterns;
};
static_assert(sizeof(RecordBytes) == 36);
struct PatternBytes {
  uint32_t source;
  float weight;
  uint64_t lit, dark;
};
static_assert(sizeof(PatternBytes) == 24);
constexpr uint32_t front_flag = 1, edge_flag = 2;

}  // namespace

void PixelRecords::note(int x, int y, ShadowRecord&& record, bool is_first) {
  const size_t i = index(x, y);
  if (!is_first && !is_same_surface(records[i], record)) has_edge[i] = 1;
  records[i] = std::move(record);
}

void PixelRecords::save(int x, int y, std::vector<uint8_t>& out) const {
  const size_t i = index(x, y);
  const ShadowRecord& r = records[i];
  append(out,
         RecordBytes{r.geometry, (r.is_front ? front_flag : 0) | (has_edge[i] != 0 ? edge_flag : 0),
                     r.normal, r.position, uint32_t(r.patterns.size())});
  for (const SourcePattern& p : r.patterns)
    append(out, PatternBytes{p.source, p.weight, p.pattern.lit, p.pattern.dark});
}

bool PixelRecords::load(int x, int y, ByteReader& in) {
  if (in.left() < sizeof(RecordBytes)) return false;
  const auto b = in.next<RecordBytes>();
  if (b.flags > (front_flag | edge_flag) || b.patterns > in.left() / sizeof(PatternBytes))
    return false;
  const size_t i = index(x, y);
  records[i] = {b.geometry, (b.flags & front_flag) != 0, b.normal, b.position, {}};
  has_edge[i] = (b.flags & edge_flag) != 0 ? 1 : 0;
  for (uint32_t k = 0; k < b.patterns; ++k) {
    const auto p = in.next<PatternBytes>();
    records[i].patterns.push_back({p.source, p.weight, {p.lit, p.dark}});
  }
  return true;
}

NeighbourRecords PixelRecords::around(int x, int y) const {
  NeighbourRecords r{};
  r[0] = &records[index(x, y)];
  for (size_t k = 0; k < neighbours.size(); ++k) {
    const int nx = x + neighbours[k].first, ny = y + neighbours[k].second;
    if (is_inside(window, nx, ny)) r[k + 1] = &records[index(nx, ny)];
  }
  return r;
}

PixelLooks::PixelLooks(const Film& film, bool has_known, const PixelRect& window, int y0, int y1)
    : rect_{window.x0, std::max(window.y0, y0 - reach), window.x1,
            std::min(window.y1, y1 + reach)} {
  looks_.reserve(size_t(rect_.width()) * size_t(rect_.height()));
  for (int y = rect_.y0; y < rect_.y1; ++y)
    for (int x = rect_.x0; x < rect_.x1; ++x)
      looks_.push_back({film.estimate(x, y), has_known ? film.known(x, y) : KnownSums{}});
}

namespace {

// Mean and variance of one quantity over the samples of a pixel.
struct Varying {
  double mean = 0, variance = 0;
  double independent = 0;  // part of the variance that does not depend on the position in the pixel
};

// Results of the first pass around a pixel, without the pixel's own samples.
struct Surroundings {
  double mean = 0;           // mean luminance of the neighbours
  double low = 0, high = 0;  // extremes of the neighbours' means
  Varying largest;           // the neighbour with the largest variance
  Varying usual;             // the neighbour with the median variance
  // Largest variance among neighbours that differ only by a known light outline (is_apart), without
  // the lamps' own light. Such variance, as of a surface next to a lamp, continues in the pixel.
  Varying apart;
  double mean_variance = 0;
  // Variance within a pixel of the plane that fits the neighbours' means. Stratified samples err
  // little by it, so the variances above exclude it.
  double slope_variance = 0;
  bool has_contrast = false;  // between neighbours on opposite sides
  // A neighbour's rays met different surfaces although its corners show no edge.
  bool has_sub_pixel_features = false;
};

bool differ(const RefinementView& v, int ax, int ay, int bx, int by,
            const RefinementOptions& options) {
  const double a = v.looks.at(ax, ay).estimate.luminance, b = v.looks.at(bx, by).estimate.luminance;
  if (std::abs(a - b) > double(options.contrast) * std::max(a + b, v.typical)) return true;
  const ShadowRecord &p = v.records.records[v.records.index(ax, ay)],
                     &q = v.records.records[v.records.index(bx, by)];
  return is_same_surface(p, q) &&
         double(pattern_contrast(p, q)) >
             double(options.pattern_contrast) * std::max({a, b, v.typical});
}

Varying known_of(const KnownSums& k) {
  const double n = k.count, mean = double(k.luminance) / n;
  return {mean, n > 1 ? std::max(double(k.squares) / n - sqr(mean), 0.0) * n / (n - 1) : 0.0};
}

// Variance of samples of one pixel due to a slope: a plane fitted to the means of its neighbours.
class Slope {
 public:
  void add(int dx, int dy, double mean) {
    n_ += 1;
    sum_ += Vec3d(dx, dy, mean);
    xx_ += dx * dx, yy_ += dy * dy, xy_ += dx * dy;
    xz_ += dx * mean, yz_ += dy * mean;
  }
  double variance() const {
    constexpr double of_unit_slope = 1.0 / 12;
    const Vec3d m = sum_ * (1 / std::max(n_, 1.0));
    const double xx = xx_ - n_ * m.x * m.x, yy = yy_ - n_ * m.y * m.y, xy = xy_ - n_ * m.x * m.y,
                 xz = xz_ - n_ * m.x * m.z, yz = yz_ - n_ * m.y * m.z;
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.5)) return 0;  // neighbours in a line, or too few
    const double sx = (xz * yy - yz * xy) / determinant, sy = (yz * xx - xz * xy) / determinant;
    return (sqr(sx) + sqr(sy)) * of_unit_slope;
  }

 private:
  double n_ = 0, xx_ = 0, yy_ = 0, xy_ = 0, xz_ = 0, yz_ = 0;
  Vec3d sum_;
};

// Factor by which a slope raises the variance estimated from a pixel's few samples, one per quarter
// of the pixel: they differ more than independent ones.
constexpr double slope_in_samples = 1.25;

// Up to eight neighbours, ordered by variance.
class Ordered {
 public:
  void add(const Varying& v) {
    size_t at = count_++;
    for (; at > 0 && values_[at - 1].variance > v.variance; --at) values_[at] = values_[at - 1];
    values_[at] = v;
  }
  const Varying& largest() const { return values_[count_ - 1]; }
  const Varying& middle() const { return values_[count_ / 2]; }

 private:
  std::array<Varying, 8> values_{};
  size_t count_ = 0;
};

// True if all light outlines in the pixel are known. The lamps' light then does not vary within the
// pixel, but it is part of its mean.
bool has_known_light(const RefinementView& v, int x, int y) {
  return v.edges.has_light_edge(x, y) && !v.edges.has_unknown_light_edge(x, y);
}

// True if a neighbour differs from a pixel without edges only by a light outline with known
// coverage.
bool is_apart(const RefinementView& v, int x, int y, int nx, int ny) {
  return has_known_light(v, nx, ny) && !v.edges.has_light_edge(x, y) &&
         !v.edges.has_surface_edge(x, y);
}

bool are_all_apart(const RefinementView& v, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if ((dx != 0 || dy != 0) && is_inside(v.records.window, x + dx, y + dy) &&
          !is_apart(v, x, y, x + dx, y + dy))
        return false;
  return true;
}

// `of` returns the varying quantity of a pixel. are_comparable: its means may be compared with
// those of the pixel.
template <class Of>
Surroundings look_around(const RefinementView& v, int x, int y, bool are_comparable,
                         const RefinementOptions& options, const Of& of) {
  const PixelRect& w = v.records.window;
  Surroundings s;
  Ordered varying;
  Slope slope;
  size_t count = 0;
  const bool counts_all = are_all_apart(v, x, y);
  const auto counts = [&](int nx, int ny) { return counts_all || !is_apart(v, x, y, nx, ny); };
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || !is_inside(w, x + dx, y + dy)) continue;
      const Varying e = of(x + dx, y + dy);
      if (!counts(x + dx, y + dy)) {
        if (e.variance > s.apart.variance) s.apart = e;
        continue;
      }
      s.low = count > 0 ? std::min(s.low, e.mean) : e.mean;
      s.high = count > 0 ? std::max(s.high, e.mean) : e.mean;
      s.mean_variance += e.variance;
      slope.add(dx, dy, e.mean);
      s.mean += v.looks.at(x + dx, y + dy).estimate.luminance;
      varying.add(e);
      s.has_sub_pixel_features |= v.records.has_edge[v.records.index(x + dx, y + dy)] != 0 &&
                                  !v.edges.has_surface_edge(x + dx, y + dy);
      ++count;
      const bool is_first_of_pair = dx + dy == -1;  // the left or the upper one
      if (is_first_of_pair && is_inside(w, x - dx, y - dy) && counts(x - dx, y - dy))
        s.has_contrast |= differ(v, x + dx, y + dy, x - dx, y - dy, options);
    }
  if (count == 0) return s;
  s.mean /= double(count);
  s.mean_variance /= double(count);
  if (are_comparable && !is_left_out<"slopes">())
    s.slope_variance = slope.variance();
  else
    s.low = s.high;
  s.largest = varying.largest();
  s.usual = varying.middle();
  for (Varying* of_sample : {&s.largest, &s.usual, &s.apart})
    of_sample->variance = std::max(of_sample->variance - slope_in_samples * s.slope_variance, 0.0);
  return s;
}

// Returns the variance that a pixel in clutter may have although its neighbours look alike. If n
// rays saw nothing, the next one does with probability 1 / (n + 2) (Laplace's rule of succession),
// and then varies like the surroundings. A single line through the surroundings is not clutter.
// `of_slope`: Surroundings::slope_variance; `noticed`: the least variance of a sample that counts.
template <class Of>
double variance_amid_clutter(const RefinementView& v, int x, int y, double of_slope, double noticed,
                             const Of& of) {
  if (is_left_out<"clutter">()) return 0;
  constexpr int reach = 2;
  static_assert(reach <= PixelLooks::reach);
  constexpr double rays = 32;  // those of eight neighbours, four each
  // If a share p of a pixel differs by c, the variance is p (1 - p) c². Its mean over p is c² / 6.
  constexpr double squares_of_variance = 6;
  int all = 0, varying = 0;
  double sum = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      if ((dx == 0 && dy == 0) || !is_inside(v.records.window, x + dx, y + dy)) continue;
      if (is_apart(v, x, y, x + dx, y + dy)) continue;
      const double variance = of(x + dx, y + dy).variance - slope_in_samples * of_slope;
      ++all;
      if (variance <= noticed) continue;
      ++varying;
      sum += variance;
    }
  constexpr double least = 0.25, full = 0.5;
  if (varying <= least * all) return 0;
  const double weight = std::min((double(varying) / all - least) / (full - least), 1.0);
  return weight * squares_of_variance / (rays + 2) * sum / varying;
}

// Returns the mean variance of nearby pixels with an edge. An edge extends beyond the nearest
// neighbours, whose few rays may all have missed a narrow feature along it, such as a reveal or a
// rim.
template <class Of>
double variance_along_edge(const RefinementView& v, int x, int y, const Of& of) {
  if (is_left_out<"variance along edges">()) return 0;
  constexpr int reach = PixelLooks::reach;
  int count = 0;
  double sum = 0;
  for (int py = y - reach; py <= y + reach; ++py)
    for (int px = x - reach; px <= x + reach; ++px) {
      if ((px == x && py == y) || !is_inside(v.records.window, px, py)) continue;
      if (!v.edges.has_surface_edge(px, py)) continue;
      sum += of(px, py).variance;
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

// Returns the variance of a pixel with a sub-pixel feature of unknown coverage p and contrast c. It
// is the mean of p (1 - p) c² over all p and all c up to the luminance around.
double variance_of_sub_pixel_feature(double mean) {
  return sqr(mean) / 18;
}

}  // namespace

int surrogates_wanted(const RefinementView& v, int x, int y, const RefinementOptions& options) {
  const auto of = [&](int px, int py) { return known_of(v.looks.at(px, py).known); };
  const bool is_light_known = has_known_light(v, x, y);
  const Surroundings s = look_around(v, x, y, !is_light_known, options, of);
  const bool has_edge = v.edges.has_surface_edge(x, y), has_light = v.edges.has_light_edge(x, y);
  const double allowed = allowed_error(double(options.error), s.mean, v.typical);
  const double clutter = variance_amid_clutter(v, x, y, s.slope_variance, sqr(allowed), of);
  if (!has_edge && !has_light && !s.has_contrast && !s.has_sub_pixel_features && clutter <= 0 &&
      s.apart.variance <= sqr(allowed))
    return 0;
  const bool is_divided = has_edge || has_light;
  const double variance = std::max(
      {s.largest.variance, s.apart.variance, is_divided ? sqr(s.high - s.low) / 4 : 0.0, clutter,
       v.edges.has_sub_pixel_feature(x, y) ? variance_of_sub_pixel_feature(s.mean) : 0.0});
  // Stratified samples of a pixel with an edge err by n^-3/4. The minimum applies since the
  // neighbours may not have seen the lamp.
  const double least = is_light_known ? 64 : has_light ? least_with_lamp : 0;
  const double wanted = variance > 0 ? std::pow(variance / sqr(allowed), 2.0 / 3) : 0;
  if (std::max(wanted, least) <= 4) return 0;
  int count = 16;
  while (count < most_surrogates && count < std::max(wanted, least)) count *= 2;
  return count;
}

int samples_wanted(const RefinementView& v, int x, int y, bool has_surrogates, int first, int most,
                   const RefinementOptions& options) {
  if (v.edges.has_unknown_light_edge(x, y) && !has_surrogates && !options.is_noise) return most;
  const auto of = [&](int px, int py) -> Varying {
    const PixelEstimate& e = v.looks.at(px, py).estimate;
    if (has_surrogates) return {e.rest, sqr(e.error_of_rest) * e.samples, e.independent_variance};
    return {e.luminance, sqr(e.standard_error) * e.samples, e.independent_variance};
  };
  const Surroundings s =
      look_around(v, x, y, has_surrogates || !has_known_light(v, x, y), options, of);
  const bool has_edge = v.edges.has_surface_edge(x, y);
  const bool is_uneven = has_edge || s.has_contrast || s.has_sub_pixel_features;
  if (!is_uneven && !options.is_everywhere) return first;
  Varying neighbour = is_uneven && !is_left_out<"largest neighbour">() ? s.largest : s.usual;
  if (has_surrogates && s.apart.variance > neighbour.variance) neighbour = s.apart;
  double variance = neighbour.variance;
  if (options.is_noise) variance = s.mean_variance;
  // Two surfaces within the pixel may differ as much as the darkest and the brightest neighbour.
  if (has_edge && !options.is_noise)
    variance = std::max(
        {variance, sqr(s.high - s.low) / 4, variance_along_edge(v, x, y, of),
         v.edges.has_sub_pixel_feature(x, y) ? variance_of_sub_pixel_feature(s.mean) : 0.0});
  const double allowed = allowed_error(double(options.error), s.mean, v.typical);
  // Stratification does not help with sub-pixel features.
  SampleSpread spread;
  spread.chance = options.is_noise ? variance : std::min(variance, neighbour.independent);
  (s.has_sub_pixel_features ? spread.thin : spread.placed) = variance - spread.chance;
  if (!options.is_noise)
    spread.clutter = variance_amid_clutter(v, x, y, s.slope_variance, sqr(allowed), of);
  double wanted = samples_for(spread, allowed, double(options.most_even), options.evenness);
  if (options.is_noise && options.proportion > 0)
    wanted = options.proportion * share_of_samples(wanted, options.evenness);
  // A slope leaves a variance of n^-3 with n stratified samples.
  if (!options.is_noise) wanted = std::max(wanted, std::cbrt(s.slope_variance / sqr(allowed)));
  if (has_surrogates) wanted = std::max(wanted, double(options.least_with_surrogates));
  // The few first rays of the pixels around may all have missed a lamp smaller than a pixel.
  if (options.is_noise && v.edges.has_unknown_light_edge(x, y))
    wanted = std::max(wanted, least_paths_with_lamp);
  return wanted < double(most) ? std::clamp(int(std::ceil(wanted)), first, most) : most;
}

}  // namespace troffer
