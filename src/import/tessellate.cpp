#include "import/tessellate.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

constexpr int azimuth_steps = 64;
constexpr int polar_steps = 32;

struct SurfacePoint {
  Vec3 position, normal;
};

// Appends a (nu+1) × (nv+1) grid of points over (u,v) in [0,1]². Where a quad shrinks to a
// triangle, the half without area is left out.
template <class Point>
void append_grid(Mesh& mesh, int nu, int nv, const Point& point) {
  const auto first = uint32_t(mesh.positions.size());
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const SurfacePoint p = point(i, j);
      mesh.positions.push_back(p.position);
      mesh.normals.push_back(p.normal);
      mesh.uvs.push_back({float(i) / float(nu), float(j) / float(nv)});
    }
  }
  const auto at = [&](int i, int j) {
    return first + uint32_t(j) * uint32_t(nu + 1) + uint32_t(i);
  };
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if (p != q && q != r && r != p) mesh.triangles.push_back({a, b, c});
  };
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

// Returns cosine and sine of the azimuth at step i of n. The last step of a full turn equals the
// first.
Vec2d azimuth(int i, int n, double phi_max_rad) {
  const bool closes = phi_max_rad >= 2 * pi * (1 - 1e-12);
  const double phi = closes && i == n ? 0 : phi_max_rad * i / n;
  return {std::cos(phi), std::sin(phi)};
}

int azimuth_count(double phi_max_rad) {
  return std::max(3, int(std::ceil(azimuth_steps * phi_max_rad / (2 * pi))));
}

}  // namespace

Mesh tessellate_sphere(double radius, double z_min, double z_max, double phi_max_rad) {
  const double theta_low = std::acos(std::clamp(z_min / radius, -1.0, 1.0));
  const double theta_high = std::acos(std::clamp(z_max / radius, -1.0, 1.0));
  const int nu = azimuth_count(phi_max_rad);
  const int nv = std::max(2, int(std::ceil(polar_steps * (theta_low - theta_high) / pi)));
  Mesh mesh;
  append_grid(mesh, nu, nv, [&](int i, int j) {
    const double theta = lerp(theta_low, theta_high, double(j) / nv);
    const bool is_pole = (j == 0 && z_min <= -radius) || (j == nv && z_max >= radius);
    const double s = is_pole ? 0 : std::sin(theta);
    const Vec2d a = azimuth(i, nu, phi_max_rad);
    const Vec3d n(a.x * s, a.y * s, std::cos(theta));
    return SurfacePoint{Vec3(n * radius), Vec3(n)};
  });
  return mesh;
}

Mesh tessellate_disk(double height, double radius, double inner_radius, double phi_max_rad) {
  const int nu = azimuth_count(phi_max_rad);
  Mesh mesh;
  append_grid(mesh, nu, 1, [&](int i, int j) {
    const double r = j == 0 ? radius : inner_radius;  // v = 0 at the rim
    const Vec2d a = azimuth(i, nu, phi_max_rad);
    return SurfacePoint{Vec3(Vec3d(a.x * r, a.y * r, height)), Vec3(0, 0, 1)};
  });
  return mesh;
}

Mesh tessellate_cylinder(double radius, double z_min, double z_max, double phi_max_rad) {
  const int nu = azimuth_count(phi_max_rad);
  Mesh mesh;
  append_grid(mesh, nu, 1, [&](int i, int j) {
    const Vec2d a = azimuth(i, nu, phi_max_rad);
    return SurfacePoint{Vec3(Vec3d(a.x * radius, a.y * radius, j == 0 ? z_min : z_max)),
                        Vec3(Vec3d(a.x, a.y, 0))};
  });
  return mesh;
}

bool is_planar(const BilinearPatch& patch) {
  const Vec3d p(patch.corners[0]);
  const Vec3d a = Vec3d(patch.corners[1]) - p, b = Vec3d(patch.corners[2]) - p;
  const Vec3d c = Vec3d(patch.corners[3]) - p;
  const double size = std::max({length(a), length(b), length(c)});
  return std::abs(dot(cross(a, b), c)) <= 1e-5 * size * size * size;
}

void append_patch(Mesh& mesh, const BilinearPatch& patch, int cells) {
  const bool has_normals =
      mesh.positions.empty() ? patch.is_smooth || cells > 1 : !mesh.normals.empty();
  const auto& c = patch.corners;
  const auto blend = [](const auto& v, float s, float t) {
    return (v[0] * (1 - s) + v[1] * s) * (1 - t) + (v[2] * (1 - s) + v[3] * s) * t;
  };
  const size_t first = mesh.positions.size();
  append_grid(mesh, cells, cells, [&](int i, int j) {
    const float s = float(i) / float(cells), t = float(j) / float(cells);
    // Exact corners, so that adjacent patches meet.
    const bool is_corner = (i == 0 || i == cells) && (j == 0 || j == cells);
    const size_t corner = size_t(i == cells) + 2 * size_t(j == cells);
    const Vec3 du = (c[1] - c[0]) * (1 - t) + (c[3] - c[2]) * t;
    const Vec3 dv = (c[2] - c[0]) * (1 - s) + (c[3] - c[1]) * s;
    return SurfacePoint{is_corner ? c[corner] : blend(c, s, t),
                        patch.is_smooth ? blend(patch.normals, s, t) : cross(du, dv)};
  });
  for (size_t i = first; i < mesh.uvs.size(); ++i)
    mesh.uvs[i] = blend(patch.uvs, mesh.uvs[i].x, mesh.uvs[i].y);
  if (!has_normals) mesh.normals.clear();
}

}  // namespace troffer
