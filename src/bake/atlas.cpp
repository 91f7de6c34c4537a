#include "bake/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake/flat_triangles.h"
#include "bake/packing.h"
#include "base/error.h"

namespace troffer {

namespace {

constexpr int64_t most_texels = int64_t(1) << 27;
constexpr int most_pages = 64;
// Least covered area of a texel, relative to the texel, or to the triangle if that is smaller.
constexpr double least_covered = 1e-9;

int texels_along(double metres, double per_metre) {
  const double n = std::ceil(metres * per_metre - 1e-6);
  return n < 1 ? 1 : n > 1e8 ? 100000000 : int(n);
}

double per_metre_of(const Chart& chart, const Stand& stand, double per_metre) {
  return per_metre * double(stand.scale) * double(chart.fineness);
}

PackGroup group_of(const BakedSurfaces& s, const Stand& stand, double per_metre, int gutter) {
  PackGroup group;
  for (const Chart& c : s.charts_of(stand)) {
    const double d = per_metre_of(c, stand, per_metre);
    group.sizes.push_back({texels_along(double(c.size.x), d) + 2 * gutter,
                           texels_along(double(c.size.y), d) + 2 * gutter});
  }
  return group;
}

std::vector<PackGroup> groups_of(const BakedSurfaces& s, const std::vector<double>& per_metre,
                                 int gutter) {
  std::vector<PackGroup> groups;
  for (size_t i = 0; i < s.stands.size(); ++i)
    groups.push_back(group_of(s, s.stands[i], per_metre[i], gutter));
  return groups;
}

bool fits_a_page(PackGroup group, int size) {
  std::vector<PackGroup> alone{std::move(group)};
  return pack(alone, size, 1) > 0;
}

// Returns the highest density at which everything fits one page, within a percent; 0 if there is
// none.
double density_of_page(const BakedSurfaces& s, int size, int gutter) {
  double area = 0;
  for (const Stand& stand : s.stands)
    for (const Chart& c : s.charts_of(stand))
      area += double(c.size.x) * double(c.size.y) * double(stand.scale) * double(stand.scale);
  if (!(area > 0) || !std::isfinite(area)) area = 1;
  double high = size / std::sqrt(area), low = 0;
  for (int i = 0; i < 40 && high > low * 1.005; ++i) {
    const double at = i == 0 ? high : low > 0 ? (low + high) / 2 : high / 2;
    std::vector<PackGroup> groups = groups_of(s, std::vector<double>(s.stands.size(), at), gutter);
    (pack(groups, size, 1) > 0 ? low : high) = at;
  }
  return low;
}

void place_vertices(const BakedSurfaces& s, const std::vector<double>& per_metre,
                    const std::vector<PackGroup>& groups, Atlas& atlas) {
  for (size_t i = 0; i < s.stands.size(); ++i) {
    const ChartedMesh& mesh = s.charted[s.stands[i].charted];
    std::vector<Vec2> at(mesh.places.size());
    for (size_t c = 0; c < mesh.charts.size(); ++c) {
      const Chart& chart = mesh.charts[c];
      const double d = per_metre_of(chart, s.stands[i], per_metre[i]);
      const TexelAt corner = groups[i].at[c];
      const TexelSize size = groups[i].sizes[c];
      // The chart is centred in its rectangle, which is rounded up to whole texels.
      const double x = corner.x + (size.width - double(chart.size.x) * d) / 2;
      const double y = corner.y + (size.height - double(chart.size.y) * d) / 2;
      for (const uint32_t t : chart.triangles)
        for (const uint32_t v : mesh.mesh.triangles[t])
          at[v] = {float(x + double(mesh.places[v].x) * d),
                   float(y + double(mesh.places[v].y) * d)};
    }
    atlas.page.push_back(groups[i].page);
    atlas.texel_of_vertex.push_back(std::move(at));
  }
}

// Returns the smallest page that holds all groups, doubling from 64 texels, or the largest one.
int page_for(std::vector<PackGroup>& groups, int largest) {
  for (int size = 64; size < largest; size *= 2)
    if (pack(groups, size, 1) > 0) return size;
  return largest;
}

}  // namespace

Atlas make_atlas(const BakedSurfaces& s, const AtlasOptions& o) {
  Atlas atlas;
  atlas.texels_per_metre = o.texels_per_metre;
  bool is_one = false;
  if (!(o.texels_per_metre > 0)) {
    atlas.size = o.resolution;
    atlas.texels_per_metre = density_of_page(s, o.resolution, o.gutter);
    is_one = atlas.texels_per_metre > 0;
    // The gutters of many small charts may fill the page alone.
    if (!is_one) atlas.texels_per_metre = 1e-6;
  }
  std::vector<double> per_metre(s.stands.size(), atlas.texels_per_metre);
  std::vector<PackGroup> groups = groups_of(s, per_metre, o.gutter);
  if (!is_one) atlas.size = page_for(groups, o.largest_page);
  for (size_t i = 0; i < groups.size() && !is_one; ++i) {
    bool is_coarser = false;
    for (int tries = 0; tries < 60 && !fits_a_page(groups[i], atlas.size); ++tries) {
      is_coarser = true;
      per_metre[i] *= 0.8;
      groups[i] = group_of(s, s.stands[i], per_metre[i], o.gutter);
    }
    atlas.coarser += is_coarser;
  }
  atlas.pages = pack(groups, atlas.size, most_pages);
  if (atlas.pages == 0 && !groups.empty())
    throw UsageError(fmt::format(
        "the surfaces do not fit {} pages of {} x {} texels: ask for fewer texels per metre",
        most_pages, atlas.size, atlas.size));
  if (int64_t(atlas.size) * atlas.size * atlas.pages > most_texels)
    throw UsageError(
        fmt::format("{} pages of {} x {} are more than 134 million texels: ask for fewer",
                    atlas.pages, atlas.size, atlas.size));
  place_vertices(s, per_metre, groups, atlas);
  return atlas;
}

Piece piece_of(const MeshInWorld& mesh, uint32_t triangle) {
  Piece piece;
  const Triangle t = mesh.triangle(triangle);
  for (size_t k = 0; k < 3; ++k) piece.positions[k] = mesh.position(t[k]);
  const auto& p = piece.positions;
  const Vec3d n = cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0]));
  const double size = length(n);
  piece.geometric_normal = size > 0 ? Vec3(n / size) : Vec3{0, 0, 1};
  for (size_t k = 0; k < 3; ++k)
    piece.normals[k] = mesh.mesh().normals.empty() ? piece.geometric_normal : mesh.normal(t[k]);
  return piece;
}

TexelSites::TexelSites(const BakedSurfaces& surfaces, const Atlas& atlas)
    : surfaces_(surfaces), atlas_(atlas) {
  uint32_t number = 0;
  for (uint32_t s = 0; s < surfaces.stands.size(); ++s)
    for (const Chart& chart : surfaces.charts_of(surfaces.stands[s])) add_chart(s, number++, chart);
}

namespace {

FlatTriangle on_page(const Mesh& mesh, const std::vector<Vec2>& at, uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {Vec2d(at[a]), Vec2d(at[b]), Vec2d(at[c])};
}

struct Covered {
  int32_t x, y;
  uint32_t triangle;
};

// Appends the texels that a triangle overlaps.
void add_covered(const FlatTriangle& t, uint32_t triangle, std::vector<Covered>& out) {
  const double y0 = std::min({t[0].y, t[1].y, t[2].y}), y1 = std::max({t[0].y, t[1].y, t[2].y});
  const double least = least_covered * std::min(1.0, std::abs(doubled_area(t)));
  for (double y = std::floor(y0); y < y1 || y == std::floor(y0); ++y) {
    FlatPolygon row(t);
    row.cut({0, -1}, -y);
    row.cut({0, 1}, y + 1);
    if (row.size < 3) continue;
    double x0 = 1e300, x1 = -1e300;
    for (size_t k = 0; k < row.size; ++k) {
      x0 = std::min(x0, row.corners[k].x);
      x1 = std::max(x1, row.corners[k].x);
    }
    for (double x = std::floor(x0); x < x1; ++x) {
      FlatPolygon square = row;
      square.cut({-1, 0}, -x);
      square.cut({1, 0}, x + 1);
      if (square.area() > least) out.push_back({int32_t(x), int32_t(y), triangle});
    }
  }
}

}  // namespace

void TexelSites::add_chart(uint32_t stand, uint32_t number, const Chart& chart) {
  const Mesh& mesh = surfaces_.charted[surfaces_.stands[stand].charted].mesh;
  std::vector<Covered> covered;
  for (const uint32_t t : chart.triangles)
    add_covered(on_page(mesh, atlas_.texel_of_vertex[stand], t), t, covered);
  std::stable_sort(covered.begin(), covered.end(), [](const Covered& a, const Covered& b) {
    return std::tuple(a.y >> 3, a.x >> 3, a.y, a.x) < std::tuple(b.y >> 3, b.x >> 3, b.y, b.x);
  });
  for (const Covered& c : covered) {
    const bool is_same = !texels_.empty() && texels_.back().chart == number &&
                         texels_.back().x == c.x && texels_.back().y == c.y;
    if (!is_same) texels_.push_back({stand, number, c.x, c.y, triangles_.size()});
    triangles_.push_back(c.triangle);
  }
}

void TexelSites::pieces(size_t site, std::vector<Piece>& out) const {
  const Texel& texel = texels_[site];
  const MeshInWorld mesh = surfaces_.mesh(surfaces_.stands[texel.stand]);
  for (const uint32_t triangle : triangles_of(site)) {
    const FlatTriangle flat = on_page(mesh.mesh(), atlas_.texel_of_vertex[texel.stand], triangle);
    const FlatPolygon p = in_square(flat, texel.x, texel.y, texel.x + 1, texel.y + 1);
    const Piece whole = piece_of(mesh, triangle);
    const double all = doubled_area(flat);
    // Barycentric weights at a place on the page. A mirrored stand reverses the order of corners.
    const bool is_turned = mesh.triangle(triangle) != mesh.mesh().triangles[triangle];
    const auto weights = [&](const Vec2d& at) {
      std::array<float, 3> w{float(doubled_area({at, flat[1], flat[2]}) / all),
                             float(doubled_area({flat[0], at, flat[2]}) / all), 0};
      for (float& x : w) x = std::clamp(x, 0.0f, 1.0f);
      w[2] = std::max(0.0f, 1 - w[0] - w[1]);
      if (is_turned) std::swap(w[1], w[2]);
      return w;
    };
    for (size_t k = 2; k < p.size; ++k) {
      Piece piece = whole;
      const std::array<Vec2d, 3> corners{p.corners[0], p.corners[k - 1], p.corners[k]};
      for (size_t j = 0; j < 3; ++j) {
        const std::array<float, 3> w = weights(corners[j]);
        const auto &q = whole.positions, &n = whole.normals;
        piece.positions[j] = q[0] * w[0] + q[1] * w[1] + q[2] * w[2];
        piece.normals[j] = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
      }
      piece.weight = std::abs(doubled_area(corners));
      out.push_back(piece);
    }
  }
}

}  // namespace troffer
