#include "light/sky_patches.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/frame.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "light/light.h"
#include "light/portal.h"

namespace troffer {

namespace {

// Half the cube's edge length in scene radii. From 256 radii away, directions err by 2^-18.
constexpr double cube_in_radii = 0x1p26;
// Allowed error of a fit, relative to the patch's mean radiance, or to the light's integral.
constexpr double fit_error = 1e-4, fit_error_of_all = 1e-5;
// A patch is halved until randomly placed samples of a coarse mask (178 of them) would err by less
// than this share of all light.
constexpr double table_error = 1e-3, samples_of_mask = 178;
// On the faces beside a portal's, the strip up to this height over the portal's plane is a patch of
// its own. Rays meet the plane very far away there.
constexpr double near_plane = 0.125;

// Nodes of the fit: Chebyshev nodes in [0,1].
constexpr double chebyshev_nodes[4] = {
    0.5 - 0.5 * 0.92387953251128674, 0.5 - 0.5 * 0.38268343236508977,
    0.5 + 0.5 * 0.38268343236508977, 0.5 + 0.5 * 0.92387953251128674};
// Positions where the fit is checked. They avoid the edges, because the ground may begin there.
constexpr double checks[6] = {1e-4, 0.13, 0.31, 0.5, 0.77, 1 - 1e-4};

// A face of the cube: directions axis + a across + b up, with a and b in [-1,1].
struct Face {
  Vec3d axis, across, up;
};

struct Square {
  double a, b, size;  // from (a,b) to (a + size, b + size)
  Vec3d at(const Face& f, double u, double v) const {
    return f.axis + f.across * (a + size * u) + f.up * (b + size * v);
  }
};

// Returns the matrix whose row i gives the coefficient of t^i from the values at the nodes.
std::array<std::array<double, 4>, 4> coefficients_of_values() {
  std::array<std::array<double, 4>, 4> m{};
  for (size_t n = 0; n < 4; ++n) {
    std::array<double, 4> c{1, 0, 0, 0};  // coefficients of the product of (t - t_k) / (t_n - t_k)
    size_t degree = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (k == n) continue;
      const double scale = 1 / (chebyshev_nodes[n] - chebyshev_nodes[k]);
      for (size_t i = ++degree; i > 0; --i) c[i] = (c[i - 1] - chebyshev_nodes[k] * c[i]) * scale;
      c[0] *= -chebyshev_nodes[k] * scale;
    }
    for (size_t i = 0; i < 4; ++i) m[i][n] = c[i];
  }
  return m;
}

float value_at(const FarPolynomial& c, float u, float v) {
  float sum = 0;
  for (size_t i = 4; i-- > 0;)
    sum = sum * u + (c[i][0] + v * (c[i][1] + v * (c[i][2] + v * c[i][3])));
  return sum;
}

// Cuts one light into patches.
class Cutter {
 public:
  Cutter(const Scene& scene, const LightPrimitives& primitives, uint32_t primitive,
         const Box& bounds, std::vector<SkyPatch>& out)
      : scene_(scene),
        piece_(primitives[primitive]),
        light_(scene.lights[piece_.light]),
        primitive_(primitive),
        centre_(bounds.centre()),
        distance_(cube_in_radii * 0.5 * std::max(double(bounds.diagonal()), 1e-6)),
        matrix_(coefficients_of_values()),
        out_(out) {
    all_ = 4 * pi * double(luminance(piece_.mean_radiance));
  }

  void cut_faces(std::vector<std::unique_ptr<const FarTable>>& tables) {
    if (is_even() && piece_.portal != nullptr) return cut_before_portal();
    // Aligns the cube so that a sky's horizon runs along edges of patches.
    const Vec3d z = normalize(Vec3d(light_.axes[2]));
    const Vec3d other = std::abs(z.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
    const Vec3d x = normalize(other - z * dot(other, z)), y = cross(z, x);
    for (const double side : {1.0, -1.0})
      for (const Face& f : {Face{x * side, y, z}, Face{y * side, z, x}, Face{z * side, x, y}}) {
        if (is_even()) {
          SkyPatch cell = cell_of(f, {-1, -1, 2});
          cell.is_even = true;
          cell.mean = light_.radiance;
          out_.push_back(cell);
          continue;
        }
        tables.push_back(table_of(f));
        table_ = tables.back().get();
        cut(f, {-1, -1, 2}, 0, 0, table_->size);
      }
  }

  // Adds a uniform light's patches that its portal may show. Edges lie in the portal's plane.
  void cut_before_portal() {
    const auto [x, y, z] = piece_.portal->axes();
    add_even({z, x, y}, -1, 1, -1, 1);
    for (const double side : {1.0, -1.0})
      for (const auto& [axis, across] : {std::pair{x, y}, {y, x}}) {
        const Face f{axis * side, across, z};
        add_even(f, -1, 1, 0, near_plane);
        add_even(f, -1, 1, near_plane, 1);
      }
  }

  void add_disk() {
    const Vec3d axis = -normalize(Vec3d(light_.direction));
    const Framed frame(axis);
    const double radius = std::tan(double(light_.angular_radius));
    SkyPatch cell = cell_of({axis, frame.tangent, frame.bitangent}, {-radius, -radius, 2 * radius});
    cell.is_disk = cell.is_even = true;
    cell.mean = light_.radiance;
    out_.push_back(cell);
  }

 private:
  bool is_even() const {
    return light_.kind == LightKind::environment && light_.environment == no_environment;
  }
  const EnvironmentMap* image() const {
    return light_.kind == LightKind::environment ? &scene_.environments[size_t(light_.environment)]
                                                 : nullptr;
  }

  SkyPatch cell_of(const Face& f, const Square& s) const {
    SkyPatch cell;
    cell.primitive = primitive_;
    const double edge = s.size * distance_;
    cell.plane = {centre_ + s.at(f, 0, 0) * distance_, f.across * edge, f.up * edge, -f.axis};
    cell.along_u = Vec3(f.across / edge);
    cell.along_v = Vec3(f.up / edge);
    cell.from_u = float(s.a / s.size);
    cell.from_v = float(s.b / s.size);
    cell.height = distance_;
    return cell;
  }

  // Adds a uniform patch from (a0, b0) to (a1, b1) of the face.
  void add_even(const Face& f, double a0, double a1, double b0, double b1) {
    const double width = (a1 - a0) * distance_, height = (b1 - b0) * distance_;
    SkyPatch cell;
    cell.primitive = primitive_;
    cell.plane = {centre_ + (f.axis + f.across * a0 + f.up * b0) * distance_, f.across * width,
                  f.up * height, -f.axis};
    cell.along_u = Vec3(f.across / width);
    cell.along_v = Vec3(f.up / height);
    cell.from_u = float(a0 / (a1 - a0));
    cell.from_v = float(b0 / (b1 - b0));
    cell.height = distance_;
    cell.is_even = true;
    cell.mean = light_.radiance;
    out_.push_back(cell);
  }

  Rgb radiance(const Vec3d& direction) const {
    return radiance_beyond(scene_, light_, Vec3(normalize(direction)));
  }

  // Returns a table of means, as fine as the image's texels within limits of memory.
  std::unique_ptr<const FarTable> table_of(const Face& f) const {
    int texels = 128, each = 1;  // texels along a face's edge; lookups per value and direction
    if (const EnvironmentMap* map = image())
      texels = map->projection == SphereMap::lat_long ? map->width / 4 : map->width / 2;
    auto table = std::make_unique<FarTable>();
    table->size = int(std::bit_ceil(unsigned(std::clamp(texels, 128, 512))));
    // A bright texel is a narrow peak, which too few bilinear lookups would miss.
    each = std::clamp((texels + table->size - 1) / table->size,
                      image() == nullptr  ? 1
                      : table->size > 256 ? 2
                                          : 4,
                      8);
    const int n = table->size;
    table->values.resize(size_t(n) * size_t(n));
    const Square all{-1, -1, 2};
    const double step = 1.0 / (double(n) * each);
    parallel_for(size_t(n), 0, [&](size_t row) {
      const int y = int(row);
      for (int x = 0; x < n; ++x) {
        Rgb sum;
        for (int i = 0; i < each * each; ++i)
          sum += radiance(
              all.at(f, (x * each + i % each + 0.5) * step, (y * each + i / each + 0.5) * step));
        table->values[row * size_t(n) + size_t(x)] = sum * (1 / float(each * each));
      }
    });
    return table;
  }

  // Cuts a square of the face, which covers n × n table entries from (x,y) on.
  void cut(const Face& f, const Square& s, int x, int y, int n) {
    SkyPatch cell = cell_of(f, s);
    cell.table = table_;
    cell.table_x = x;
    cell.table_y = y;
    cell.table_size = n;
    set_fit(f, s, cell);
    const Spread spread = look_at_table(f, s, cell);
    if (spread.most == 0) return;
    cell.is_even = spread.is_even;
    if (cell.is_even || is_fitted(f, s, cell, spread.steradians)) {
      cell.table = nullptr;
    } else if (n > 2 && spread.deviation * spread.steradians >
                            table_error * std::sqrt(samples_of_mask) * all_) {
      const double half = s.size / 2;
      for (const int j : {0, 1})
        for (const int i : {0, 1})
          cut(f, {s.a + i * half, s.b + j * half, half}, x + i * n / 2, y + j * n / 2, n / 2);
      return;
    }
    out_.push_back(cell);
  }

  struct Spread {
    // standard deviation of luminance from the mean or the fit
    double deviation = 0, steradians = 0;
    float most = 0;  // largest colour component
    bool is_even = true;
  };

  // Sets the patch's mean and unevenness, and returns the spread. Precondition: the fit is set.
  Spread look_at_table(const Face& f, const Square& s, SkyPatch& cell) const {
    Spread spread;
    double r = 0, g = 0, b = 0, squares = 0, from_fit = 0, weights = 0;
    const Rgb first = value(cell, 0, 0);
    for (int j = 0; j < cell.table_size; ++j)
      for (int i = 0; i < cell.table_size; ++i) {
        const Vec3d at = s.at(f, (i + 0.5) / cell.table_size, (j + 0.5) / cell.table_size);
        const double square = length_squared(at), weight = 1 / (square * std::sqrt(square));
        const Rgb l = value(cell, i, j);
        r += weight * double(l.r);
        g += weight * double(l.g);
        b += weight * double(l.b);
        squares += weight * sqr(double(luminance(l)));
        const float u = (float(i) + 0.5f) / float(cell.table_size),
                    v = (float(j) + 0.5f) / float(cell.table_size);
        from_fit += weight * sqr(double(luminance(l)) - double(fitted_luminance(cell, u, v)));
        weights += weight;
        spread.most = std::max(spread.most, max_component(l));
        spread.is_even = spread.is_even &&
                         max_component(l - first) <= 1e-6f * max_component(first) &&
                         max_component(first - l) <= 1e-6f * max_component(first);
      }
    cell.mean = {float(r / weights), float(g / weights), float(b / weights)};
    const auto mean = double(luminance(cell.mean));
    if (mean > 0) cell.unevenness = float(std::sqrt(std::max(squares / weights / sqr(mean), 1.0)));
    spread.deviation =
        std::sqrt(std::min(std::max(squares / weights - sqr(mean), 0.0), from_fit / weights));
    spread.steradians = weights * sqr(s.size / cell.table_size);
    return spread;
  }
  static const Rgb& value(const SkyPatch& c, int i, int j) {
    return c.table->values[size_t(c.table_y + j) * size_t(c.table->size) + size_t(c.table_x + i)];
  }

  static float fitted_luminance(const SkyPatch& c, float u, float v) {
    return luminance(
        {value_at(c.fit[0], u, v), value_at(c.fit[1], u, v), value_at(c.fit[2], u, v)});
  }

  // Always false for images, which may hold detail between the nodes.
  bool is_fitted(const Face& f, const Square& s, const SkyPatch& cell, double steradians) const {
    if (image() != nullptr) return false;
    double worst = 0;
    for (const double u : checks)
      for (const double v : checks) {
        const Rgb exact = radiance(s.at(f, u, v));
        for (size_t c = 0; c < 3; ++c)
          worst = std::max(worst,
                           double(std::abs(value_at(cell.fit[c], float(u), float(v)) - exact[c])));
      }
    return worst <= fit_error * double(max_component(cell.mean)) ||
           worst * steradians <= fit_error_of_all * all_;
  }

  void set_fit(const Face& f, const Square& s, SkyPatch& cell) const {
    std::array<std::array<Rgb, 4>, 4> values;
    for (size_t m = 0; m < 4; ++m)
      for (size_t n = 0; n < 4; ++n)
        values[m][n] = radiance(s.at(f, chebyshev_nodes[m], chebyshev_nodes[n]));
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j) {
          double sum = 0;
          for (size_t m = 0; m < 4; ++m)
            for (size_t n = 0; n < 4; ++n)
              sum += matrix_[i][m] * matrix_[j][n] * double(values[m][n][c]);
          cell.fit[c][i][j] = float(sum);
        }
    cell.is_grey = cell.fit[1] == cell.fit[0] && cell.fit[2] == cell.fit[0];
  }

  const Scene& scene_;
  const LightPrimitive& piece_;
  const Light& light_;
  uint32_t primitive_;
  Vec3d centre_;
  double distance_;
  double all_ = 0;  // integral of the luminance over all directions
  std::array<std::array<double, 4>, 4> matrix_;
  const FarTable* table_ = nullptr;  // that of the current face
  std::vector<SkyPatch>& out_;
};

inline float evaluate_fit(const SkyPatch& cell, const FarPolynomial& c, float x, float y, float z) {
  const Vec3 &au = cell.along_u, &av = cell.along_v;
  const float u = x * au.x + y * au.y + z * au.z - cell.from_u;
  const float v = x * av.x + y * av.y + z * av.z - cell.from_v;
  const float c0 = c[0][0] + v * (c[0][1] + v * (c[0][2] + v * c[0][3]));
  const float c1 = c[1][0] + v * (c[1][1] + v * (c[1][2] + v * c[1][3]));
  const float c2 = c[2][0] + v * (c[2][1] + v * (c[2][2] + v * c[2][3]));
  const float c3 = c[3][0] + v * (c[3][1] + v * (c[3][2] + v * c[3][3]));
  const float sum = c0 + u * (c1 + u * (c2 + u * c3));
  return sum > 0 ? sum : 0.0f;
}

TROFFER_MULTIVERSION
void evaluate_fit(const SkyPatch& cell, const FarPolynomial& c, size_t n, const float* __restrict x,
                  const float* __restrict y, const float* __restrict z, float* __restrict out) {
  for (size_t i = 0; i < n; ++i) out[i] = evaluate_fit(cell, c, x[i], y[i], z[i]);
}

void look_up(const SkyPatch& cell, size_t n, const float* x, const float* y, const float* z,
             float* r, float* g, float* b) {
  const int last = cell.table_size - 1;
  const auto size = float(cell.table_size);
  const Rgb* first = cell.table->values.data() + size_t(cell.table_y) * size_t(cell.table->size) +
                     size_t(cell.table_x);
  for (size_t i = 0; i < n; ++i) {
    const Vec3 d{x[i], y[i], z[i]};
    const int column = int((dot(d, cell.along_u) - cell.from_u) * size);
    const int row = int((dot(d, cell.along_v) - cell.from_v) * size);
    const Rgb& l = first[size_t(std::clamp(row, 0, last)) * size_t(cell.table->size) +
                         size_t(std::clamp(column, 0, last))];
    r[i] = l.r;
    g[i] = l.g;
    b[i] = l.b;
  }
}

}  // namespace

bool SkyPatch::holds(const Vec3& direction) const {
  const Vec3d d(direction);
  const double towards = -dot(plane.normal, d);
  if (!(towards > 0)) return false;
  const Vec3d at = d * (height / towards);
  const double u = dot(at, Vec3d(along_u)) - double(from_u);
  const double v = dot(at, Vec3d(along_v)) - double(from_v);
  return is_disk ? sqr(u - 0.5) + sqr(v - 0.5) <= 0.25 : u >= 0 && u <= 1 && v >= 0 && v <= 1;
}

SkyPatches::SkyPatches(const Scene& scene, const LightPrimitives& primitives) {
  const Box box = bounds(scene);
  if (box.is_empty()) return;
  for (const uint32_t p : primitives.at_infinity()) {
    const LightKind kind = scene.lights[primitives[p].light].kind;
    if (!has_sky_patches(kind)) continue;
    Cutter cutter(scene, primitives, p, box, cells_);
    if (kind == LightKind::sun)
      cutter.add_disk();
    else
      cutter.cut_faces(tables_);
  }
}

void far_radiance(const SkyPatch& cell, size_t n, const float* x, const float* y, const float* z,
                  float* r, float* g, float* b) {
  if (cell.table != nullptr) return look_up(cell, n, x, y, z, r, g, b);
  constexpr size_t few = 8;  // for fewer points, vectorization does not pay
  if (n < few && cell.is_grey) {
    for (size_t i = 0; i < n; ++i)
      r[i] = g[i] = b[i] = evaluate_fit(cell, cell.fit[0], x[i], y[i], z[i]);
    return;
  }
  evaluate_fit(cell, cell.fit[0], n, x, y, z, r);
  if (cell.is_grey) {  // most skies are grey
    std::copy_n(r, n, g);
    std::copy_n(r, n, b);
    return;
  }
  evaluate_fit(cell, cell.fit[1], n, x, y, z, g);
  evaluate_fit(cell, cell.fit[2], n, x, y, z, b);
}

}  // namespace troffer
