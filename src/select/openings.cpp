#include "select/openings.h"

#include <algorithm>
#include <cmath>

#include "light/light.h"

namespace troffer {

namespace {

// Cells along either side of a face.
constexpr uint32_t cells_along = 32;
constexpr uint32_t cells_of_face = cells_along * cells_along, faces = 6;
// Samples that decide together whether a place is mostly blocked, and its largest open share of
// solid angle. Places outside of a room, where paths arrive as well, are more open.
constexpr ptrdiff_t samples_of_place = 128;
constexpr double most_open = 0.5;
// Cells make one lamp if their radiance differs from that of its first one by at most this factor.
constexpr float most_uneven = 3;
// Samples through a cell that show its radiance well enough.
constexpr double enough_samples = 16;

using Samples = std::vector<SkySample>::iterator;

// Grows the box by all places among the samples whose sky is mostly blocked.
void grow_by_blocked(Samples first, Samples last, Box& box) {
  Box own;
  for (Samples s = first; s != last; ++s) own.grow(s->position);
  const Vec3 size = own.extent();
  const size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (last - first >= 2 * samples_of_place && size[axis] > 0) {
    const Samples middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [axis](const SkySample& a, const SkySample& b) {
      return a.position[axis] < b.position[axis];
    });
    grow_by_blocked(first, middle, box);
    grow_by_blocked(middle, last, box);
    return;
  }
  double all = 0, open = 0;
  for (Samples s = first; s != last; ++s) {
    all += double(s->inverse_pdf);
    if (s->light > 0) open += double(s->inverse_pdf);
  }
  if (open < most_open * all)
    for (Samples s = first; s != last; ++s)
      if (!(s->light > 0)) box.grow(s->position);
}

// Of the samples through a cell: their number, solid angle, and light.
struct CellSums {
  double samples = 0, all = 0, light = 0;
  void operator+=(const CellSums& o) {
    samples += o.samples;
    all += o.all;
    light += o.light;
  }
};

// Returns the sums over a cell and those around it in its face.
CellSums sums_around(const std::vector<CellSums>& cells, uint32_t cell) {
  const int n = cells_along, i = int(cell) % n, j = int(cell) / n % n;
  CellSums sums;
  for (int l = std::max(j - 1, 0); l <= std::min(j + 1, n - 1); ++l)
    for (int k = std::max(i - 1, 0); k <= std::min(i + 1, n - 1); ++k)
      sums += cells[cell + uint32_t((l - j) * n + k - i)];
  return sums;
}

}  // namespace

Openings::Openings(uint32_t piece, std::vector<SkySample> samples)
    : piece_(piece),
      lamp_of_cell_(size_t{faces} * cells_of_face, no_primitive),
      tree_(primitives_) {
  if (samples.empty()) return;
  grow_by_blocked(samples.begin(), samples.end(), box_);
  if (box_.is_empty()) return;
  lamps_.meshes.resize(1);
  std::vector<float> radiance = mean_radiance(samples);
  for (uint32_t cell = 0; cell < radiance.size(); ++cell)
    if (radiance[cell] > 0) add_lamp(cell, radiance);
  primitives_ = LightPrimitives(lamps_);
  for (int32_t& lamp : lamp_of_cell_) {
    if (lamp < 0) continue;
    const LightPrimitives::Range range = primitives_.of_light(uint32_t(lamp));
    lamp = range.first < range.last ? int32_t(range.first) : no_primitive;
  }
  tree_ = LightTree(primitives_);
}

bool Openings::contains(const Vec3& x) const {
  for (size_t axis = 0; axis < 3; ++axis)
    if (!(x[axis] >= box_.lower[axis] && x[axis] <= box_.upper[axis])) return false;
  return true;
}

// Returns the cell through which a ray leaves the box.
Openings::Exit Openings::exit_of(const Vec3& x, const Vec3& direction) const {
  size_t out = 0;
  float distance = std::numeric_limits<float>::infinity();
  for (size_t axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const float end = direction[axis] > 0 ? box_.upper[axis] : box_.lower[axis];
    const float t = (end - x[axis]) / direction[axis];
    if (t < distance) {
      distance = t;
      out = axis;
    }
  }
  const auto cell_along = [&](size_t axis) {
    const float place = (x[axis] + distance * direction[axis] - box_.lower[axis]) /
                        (box_.upper[axis] - box_.lower[axis]) * float(cells_along);
    return place > 0 ? std::min(uint32_t(place), cells_along - 1) : 0;
  };
  const auto face = uint32_t(2 * out + (direction[out] > 0 ? 1 : 0));
  return {
      (face * cells_along + cell_along((out + 2) % 3)) * cells_along + cell_along((out + 1) % 3),
      distance};
}

// Returns the mean radiance through each cell, over all directions in which receivers in the box
// look through it. Cells that few samples pass share those of the cells around them, so that chance
// leaves no gaps in an opening.
std::vector<float> Openings::mean_radiance(const std::vector<SkySample>& samples) const {
  std::vector<CellSums> cells(lamp_of_cell_.size());
  for (const SkySample& s : samples) {
    if (!contains(s.position)) continue;
    CellSums& c = cells[exit_of(s.position, s.direction).cell];
    c += {1, double(s.inverse_pdf), double(s.inverse_pdf) * double(s.light)};
  }
  std::vector<float> mean(cells.size());
  for (uint32_t i = 0; i < cells.size(); ++i) {
    const CellSums sums = cells[i].samples < enough_samples ? sums_around(cells, i) : cells[i];
    if (sums.light > 0) mean[i] = float(sums.light / sums.all);
  }
  return mean;
}

// Makes a lamp that shines into the box, of the first cell of a face and those beside it that are
// about as bright. Sets the radiance of these cells to 0.
void Openings::add_lamp(uint32_t first, std::vector<float>& radiance) {
  const uint32_t face = first / cells_of_face, i0 = first % cells_along,
                 j0 = first / cells_along % cells_along;
  const auto cell = [&](uint32_t i, uint32_t j) {
    return (face * cells_along + j) * cells_along + i;
  };
  const float like = radiance[first];
  const auto fits = [&](uint32_t i, uint32_t j) {
    const float r = radiance[cell(i, j)];
    return r > 0 && r < most_uneven * like && like < most_uneven * r;
  };
  uint32_t i1 = i0 + 1, j1 = j0 + 1;
  while (i1 < cells_along && fits(i1, j0)) ++i1;
  const auto row_fits = [&](uint32_t j) {
    for (uint32_t i = i0; i < i1; ++i)
      if (!fits(i, j)) return false;
    return true;
  };
  while (j1 < cells_along && row_fits(j1)) ++j1;
  double sum = 0;
  for (uint32_t j = j0; j < j1; ++j)
    for (uint32_t i = i0; i < i1; ++i) {
      sum += double(radiance[cell(i, j)]);
      radiance[cell(i, j)] = 0;
      lamp_of_cell_[cell(i, j)] = int32_t(lamps_.lights.size());
    }
  Light lamp;
  lamp.radiance = Rgb{float(sum / ((i1 - i0) * (j1 - j0)))};
  lamp.polygon = {corner(face, i0, j0), corner(face, i1, j0), corner(face, i1, j1),
                  corner(face, i0, j1)};
  if (face % 2 == 1) std::reverse(lamp.polygon.begin(), lamp.polygon.end());
  lamps_.lights.push_back(std::move(lamp));
}

// Returns the corner of a face's cells that has k of them before it along, and l across.
Vec3 Openings::corner(uint32_t face, uint32_t k, uint32_t l) const {
  const size_t axis = face / 2, along = (axis + 1) % 3, across = (axis + 2) % 3;
  Vec3 p;
  p[axis] = face % 2 == 1 ? box_.upper[axis] : box_.lower[axis];
  p[along] = lerp(box_.lower[along], box_.upper[along], float(k) / float(cells_along));
  p[across] = lerp(box_.lower[across], box_.upper[across], float(l) / float(cells_along));
  return p;
}

bool Openings::sample(const Vec3& x, const Vec3& n, bool both_sides, float u, const Vec2& numbers,
                      Vec3& direction) const {
  const LightChoice choice = tree_.choose(x, n, both_sides, u);
  if (choice.pmf == 0) return false;
  LightSample point;
  if (!troffer::sample(lamps_, primitives_[choice.primitive], x, numbers, point)) return false;
  direction = point.wi;
  return true;
}

float Openings::pdf(const Vec3& x, const Vec3& n, bool both_sides, const Vec3& direction) const {
  const Exit exit = exit_of(x, direction);
  const int32_t lamp = lamp_of_cell_[exit.cell];
  if (lamp < 0) return 0;
  const float pdf = tree_.pmf(x, n, both_sides, uint32_t(lamp)) *
                    pdf_solid_angle(lamps_, primitives_[size_t(lamp)], x, direction, exit.distance);
  return std::isfinite(pdf) ? pdf : 0;  // a receiver may lie in the plane of the lamp
}

}  // namespace troffer
