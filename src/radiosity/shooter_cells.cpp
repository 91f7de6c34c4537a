#include "radiosity/shooter_cells.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "radiosity/subdivide.h"

namespace troffer {

namespace {

constexpr size_t flat_cells = 10;
constexpr size_t flat_groups = 3;
constexpr size_t most_curved_cells = 48;
// Distances, in radii of the shooter, from which a group of cells, and the whole shooter, count as
// points. The error falls with the square of the distance.
constexpr float groups_from = 3.5f, one_from = 8;

float area_of(const Vec3 (&c)[3]) {
  return 0.5f * length(cross(c[1] - c[0], c[2] - c[0]));
}

// Bisects the largest triangle repeatedly.
std::vector<ShooterCell> flat_shooter_cells(const Shooter& shooter) {
  std::vector<ShooterCell> cells;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    ShooterCell cell;
    cell.corners[0] = a;
    cell.corners[1] = b;
    cell.corners[2] = c;
    cell.normal = normal;
    cell.area = area_of(cell.corners);
    if (cell.area > 0) cells.push_back(cell);
  };
  for (const LightPrimitive& p : shooter.pieces)
    for (uint32_t i = 1; i + 1 < p.vertex_count; ++i)
      add(p.vertex(0), p.vertex(i), p.vertex(i + 1), Vec3(p.normal));
  const auto make_groups = [&] {
    for (size_t i = 0; i < cells.size(); ++i) cells[i].group = uint32_t(i);
  };
  make_groups();
  while (!cells.empty() && cells.size() < flat_cells) {
    const auto largest = std::max_element(
        cells.begin(), cells.end(),
        [](const ShooterCell& a, const ShooterCell& b) { return a.area < b.area; });
    const ShooterCell c = *largest;
    cells.erase(largest);
    const size_t edge = longest_edge(c.corners).number;
    const Vec3 a = c.corners[edge], b = c.corners[(edge + 1) % 3], d = c.corners[(edge + 2) % 3];
    const Vec3 m = a * 0.5f + b * 0.5f;
    const size_t before = cells.size();
    add(a, m, d, c.normal);
    add(m, b, d, c.normal);
    if (cells.size() == before) break;  // too small to be bisected
    for (size_t k = before; k < cells.size(); ++k) cells[k].group = c.group;
    if (cells.size() <= flat_groups) make_groups();
  }
  for (ShooterCell& c : cells) c.position = (c.corners[0] + c.corners[1] + c.corners[2]) / 3.0f;
  return cells;
}

std::vector<ShooterCell> curved_shooter_cells(const RadiosityMesh& mesh, uint32_t patch) {
  const Patch& p = mesh.patches[patch];
  const uint32_t count = p.last_point - p.first_point;
  const auto step = uint32_t((count + most_curved_cells - 1) / most_curved_cells);
  std::vector<ShooterCell> cells;
  for (uint32_t i = p.first_point; i < p.last_point; i += step) {
    const ElementPoint& e = mesh.points[i];
    const auto group = uint32_t(cells.size());
    cells.push_back({e.position, e.normal, e.area, 1, {e.position, e.position, e.position}, group});
  }
  return cells;
}

bool is_plain(const Shooter& s) {
  return s.is_exact && !(s.round_radius > 0);
}

// Returns how far a disc extends out of its plane along a direction.
float reach(float radius, const Vec3& normal, const Vec3& along) {
  const float c = dot(normal, along);
  return radius * std::sqrt(std::max(0.0f, 1 - c * c));
}

}  // namespace

std::vector<ShooterCell> shooter_cells(const RadiosityMesh& mesh, uint32_t patch,
                                       const Shooter& shooter) {
  std::vector<ShooterCell> cells =
      is_plain(shooter) ? flat_shooter_cells(shooter) : curved_shooter_cells(mesh, patch);
  double area = 0, sent = 0;
  for (ShooterCell& c : cells) {
    c.share = share_at(shooter, c.position);
    area += double(c.area);
    sent += double(c.area) * double(c.share);
  }
  if (!(area > 0) || !(sent > 0)) return {};
  const auto scale = float(double(shooter.area()) / area), level = float(area / sent);
  for (ShooterCell& c : cells) {
    c.area *= scale;
    c.share *= level;
  }
  return cells;
}

ShooterBounds::ShooterBounds(const std::vector<ShooterCell>& cells, const Shooter& shooter) {
  float area = 0;
  for (const ShooterCell& c : cells) {
    centre += c.position * c.area;
    area += c.area;
  }
  centre = centre / area;
  normal = cells[0].normal;
  for (const ShooterCell& c : cells) {
    is_flat = is_flat && length_squared(c.normal - normal) < 1e-10f;
    float r = is_plain(shooter) ? 0.0f : 1.5f * std::sqrt(c.area / pi_f);
    for (const Vec3& v : c.corners) r = std::max(r, length(v - c.position));
    cell_radius = std::max(cell_radius, r);
    radius = std::max(radius, length(c.position - centre) + r);
  }
}

namespace {

// Merges cells with equal `number` into one cell at the centroid of their power.
std::vector<ShooterCell> joined(const std::vector<ShooterCell>& cells,
                                uint32_t (*number)(const ShooterCell&)) {
  std::vector<ShooterCell> out;
  std::vector<float> sent;
  for (const ShooterCell& c : cells) {
    const size_t i = number(c);
    while (out.size() <= i) {
      out.push_back({{}, c.normal, 0, 1, {}, uint32_t(out.size())});
      sent.push_back(0);
    }
    out[i].position += c.position * (c.area * c.share);
    out[i].area += c.area;
    sent[i] += c.area * c.share;
  }
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].position = out[i].position / std::max(sent[i], 1e-30f);
    out[i].share = sent[i] / std::max(out[i].area, 1e-30f);
  }
  std::erase_if(out, [](const ShooterCell& c) { return !(c.share > 0); });
  return out;
}

}  // namespace

CellLevels::CellLevels(const std::vector<ShooterCell>& cells, const ShooterBounds& bounds)
    : centre_(bounds.centre), radius_(bounds.radius), all_(cells) {
  if (!bounds.is_flat) return;
  groups_ = joined(cells, [](const ShooterCell& c) { return c.group; });
  one_ = joined(cells, [](const ShooterCell&) { return 0u; });
}

const std::vector<ShooterCell>& CellLevels::for_block(const ReceiverBlock& b) const {
  const float square = length_squared(b.centre - centre_);
  if (square > sqr(one_from * radius_ + b.radius) && !one_.empty()) return one_;
  if (square > sqr(groups_from * radius_ + b.radius) && !groups_.empty()) return groups_;
  return all_;
}

bool is_out_of_sight(const ShooterBounds& s, const ReceiverBlock& b) {
  const Vec3 d = b.centre - s.centre;
  const float slack = 1e-5f * (s.radius + b.radius + length(d));
  if (s.is_flat) {
    const float out = b.is_flat ? reach(b.radius, b.normal, s.normal) : b.radius;
    if (dot(d, s.normal) + out <= slack) return true;
  }
  if (b.is_flat) {
    const float out = s.is_flat ? reach(s.radius, s.normal, b.normal) : s.radius;
    if (-dot(d, b.normal) + out <= slack) return true;
  }
  return false;
}

}  // namespace troffer
