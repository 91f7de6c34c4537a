#include "certified/sky_patch_parts.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

// Limits of a part: its share of all environment light, and the sine of its angular radius. A part
// above either limit is halved, at most most_halvings times.
constexpr double most_share = 1.0 / 48, most_sine = 0.15;
constexpr int most_halvings = 8;
// Limit on the summed unevenness (root mean square minus mean) of all parts, relative to all light.
// The relative variance of an unoccluded sample is then at most twice that, far below what
// occlusion adds.
constexpr double uneven_enough = 0.0003;
constexpr size_t most_parts = 1024;  // limit for halving by unevenness

Vec3d middle_of(const Parallelogram& p) {
  return p.origin + (p.u + p.v) * 0.5;
}

// Luminance of an image's texels within a part of a sky patch.
struct Values {
  double mean = 0, usual = 0;  // usual: root mean square
  int columns = 0, rows = 0;   // texels covered
};

// Returns the values of the part from (s0, t0) to (s1, t1) of the patch.
Values values_of(const SkyPatch& cell, double s0, double s1, double t0, double t1) {
  const int last = cell.table_size - 1;
  const auto first_of = [&](double x) {
    return std::clamp(int(std::floor(x * cell.table_size + 1e-6)), 0, last);
  };
  const auto last_of = [&](double x) {
    return std::clamp(int(std::ceil(x * cell.table_size - 1e-6)) - 1, 0, last);
  };
  Values v;
  v.columns = last_of(s1) - first_of(s0) + 1;
  v.rows = last_of(t1) - first_of(t0) + 1;
  for (int j = 0; j < v.rows; ++j)
    for (int i = 0; i < v.columns; ++i) {
      const size_t row = size_t(cell.table_y + first_of(t0) + j),
                   column = size_t(cell.table_x + first_of(s0) + i);
      const auto l = double(luminance(cell.table->values[row * size_t(cell.table->size) + column]));
      v.mean += l;
      v.usual += sqr(l);
    }
  const double n = double(v.columns) * v.rows;
  v.mean /= n;
  v.usual = std::sqrt(v.usual / n);
  return v;
}

// A part of a source during subdivision. Lengths in metres, directions from the centre of the
// scene.
struct Piece {
  const CertifiedSource* source = nullptr;
  Parallelogram plane;
  Vec3d way;  // to the part's centre
  double area = 0, steradians = 0, sine = 0;
  Values values;  // images only
  double usual = 0, of_cell = 0;

  Piece(const CertifiedSource& s, const Parallelogram& p) : source(&s), plane(p) {
    const double height = s.far->height;
    const Parallelogram& whole = s.flat.plane;
    const Vec3d u = whole.u, v = whole.v, at = middle_of(plane) - whole.origin;
    const double a = dot(at, u) / length_squared(u), b = dot(at, v) / length_squared(v);
    way = u * (a + double(s.far->from_u)) + v * (b + double(s.far->from_v)) - whole.normal * height;
    const double distance = length(way);
    area = length(cross(plane.u, plane.v));
    steradians = area * height / (distance * sqr(distance));
    sine = 0.5 * length(plane.u + plane.v) / distance;
    usual = double(luminance(far_radiance_of(s, Vec3(way))));
    of_cell = double(luminance(s.radiance));
    if (!is_mirror_pane()) return;
    const double half_u = 0.5 * length(plane.u) / length(u),
                 half_v = 0.5 * length(plane.v) / length(v);
    values = values_of(*s.far, a - half_u, a + half_u, b - half_v, b + half_v);
    usual = of_cell = values.usual;
  }
  bool is_mirror_pane() const { return source->far->table != nullptr; }
  // Luminance × sr. A tenth of it is the patch's mean, as a defence against bright spots that the
  // centre misses.
  double strength() const { return steradians * (0.9 * usual + 0.1 * of_cell); }
  // Root mean square minus mean, luminance × sr; 0 for a single texel, which halving would not
  // change.
  double unevenness() const {
    return values.columns * values.rows > 1 ? steradians * (values.usual - values.mean) : 0.0;
  }
  std::array<Piece, 2> halves() const {
    const bool is_u = length_squared(plane.u) >= length_squared(plane.v);
    Parallelogram low = plane;
    (is_u ? low.u : low.v) *= 0.5;
    Parallelogram high = low;
    high.origin += is_u ? low.u : low.v;
    return {Piece(*source, low), Piece(*source, high)};
  }

  SkyPatchPart part() const {
    const double height = source->far->height;
    SkyPatchPart p;
    p.source = source;
    p.origin = Vec3((way + plane.origin - middle_of(plane)) * (1 / height));
    p.u = Vec3(plane.u * (1 / height));
    p.v = Vec3(plane.v * (1 / height));
    p.area = float(area / sqr(height));
    for (size_t k = 0; k < 4; ++k) {
      const Vec3 corner = p.corner(k);
      const float shine = is_mirror_pane() || !source->is_textured
                              ? float(usual)
                              : luminance(far_radiance_of(*source, corner * float(height)));
      p.strength[k] = p.area * (0.9f * shine + 0.1f * float(of_cell)) / sqr(length_squared(corner));
    }
    return p;
  }
  SkyPatchPart sun() const {
    constexpr float of_square = 0.25f * pi_f;
    SkyPatchPart p = part();
    p.area *= of_square;
    p.strength[0] = float(usual) * float(steradians) * of_square;
    return p;
  }
};

void cut(const Piece& piece, double all, int halvings, std::vector<Piece>& out) {
  if (halvings == 0 || (piece.strength() <= most_share * all && piece.sine <= most_sine)) {
    out.push_back(piece);
    return;
  }
  for (const Piece& half : piece.halves()) cut(half, all, halvings - 1, out);
}

// Halves the most uneven parts until all are even enough or there are most_parts.
void even_out(std::vector<Piece>& pieces) {
  const auto is_evener = [](const Piece& a, const Piece& b) {
    return a.unevenness() < b.unevenness();
  };
  double all = 0, uneven = 0;
  for (const Piece& p : pieces) {
    all += p.steradians * (p.is_mirror_pane() ? p.values.mean : p.usual);
    uneven += p.unevenness();
  }
  std::make_heap(pieces.begin(), pieces.end(), is_evener);
  while (uneven > uneven_enough * all && pieces.size() < most_parts) {
    std::pop_heap(pieces.begin(), pieces.end(), is_evener);
    const Piece worst = pieces.back();
    if (!(worst.unevenness() > 0)) break;
    pieces.pop_back();
    uneven -= worst.unevenness();
    for (const Piece& half : worst.halves()) {
      uneven += half.unevenness();
      pieces.push_back(half);
      std::push_heap(pieces.begin(), pieces.end(), is_evener);
    }
  }
}

}  // namespace

Rgb far_radiance_of(const CertifiedSource& source, const Vec3& way) {
  if (!source.is_textured) return source.radiance;
  Rgb l;
  far_radiance(*source.far, 1, &way.x, &way.y, &way.z, &l.r, &l.g, &l.b);
  return l;
}

SkyPatchParts cut_far_parts(std::span<const CertifiedSource> sources) {
  double all = 0;
  for (const CertifiedSource& s : sources)
    all += double(luminance(s.radiance)) * length(cross(s.flat.plane.u, s.flat.plane.v)) /
           sqr(s.far->height);
  SkyPatchParts out;
  std::vector<Piece> pieces;
  for (const CertifiedSource& s : sources) {
    const Piece whole(s, s.flat.plane);
    if (s.flat.is_disk)
      out.suns.push_back(whole.sun());
    else
      cut(whole, all, most_halvings, pieces);
  }
  even_out(pieces);
  for (const Piece& p : pieces) out.parts.push_back(p.part());
  return out;
}

}  // namespace troffer
