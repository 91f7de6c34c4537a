#include "report/luminaire_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/disjoint_sets.h"
#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "base/wildcard.h"
#include "light/web.h"
#include "report/plan_view.h"

namespace troffer {

namespace {

std::vector<LightPieces> connected(const LightPrimitives& all, const LightPieces& pieces) {
  DisjointSets sets(pieces.size());
  std::unordered_map<uint64_t, uint32_t> first;
  for (uint32_t i = 0; i < pieces.size(); ++i)
    for (uint32_t k = 0; k < all[pieces[i]].vertex_count; ++k) {
      const Vec3 p = all[pieces[i]].vertex(k) * 1e4f;
      const uint64_t key =
          hash_of(uint64_t(std::llround(p.x)), std::llround(p.y), std::llround(p.z));
      const auto [at, is_new] = first.emplace(key, i);
      if (!is_new) sets.join(at->second, i);
    }
  std::map<uint32_t, LightPieces> parts;
  for (uint32_t i = 0; i < pieces.size(); ++i) parts[sets.find(i)].push_back(pieces[i]);
  std::vector<LightPieces> list;
  for (auto& [root, part] : parts) list.push_back(std::move(part));
  return list;
}

double spot_share(const Light& e, double cosine) {
  if (e.falloff == SpotFalloff::linear) {  // in the angle
    const double inner = std::acos(double(e.cos_inner)), outer = std::acos(double(e.cos_outer));
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    return std::clamp((outer - angle) / std::max(outer - inner, 1e-9), 0.0, 1.0);
  }
  const double range = double(e.cos_inner) - double(e.cos_outer);
  const double t = range > 0 ? std::clamp((cosine - double(e.cos_outer)) / range, 0.0, 1.0)
                             : double(cosine >= double(e.cos_outer));
  return e.falloff == SpotFalloff::square ? t * t : t * t * (3 - 2 * t);
}

// Intensity of a piece in the unit direction w, cd.
double intensity_of(const Scene& scene, const LightPrimitive& p, const Vec3d& w) {
  const Light& e = scene.lights[p.light];
  const double lm = scene.is_photometric ? 1 : luminous_efficacy;
  if (e.web >= 0) return 0;  // added once for the whole opening, by web_intensity()
  if (!p.has_surface())
    return lm * double(luminance(e.radiance)) *
           (e.kind == LightKind::spot ? spot_share(e, dot(Vec3d(e.direction), w)) : 1);
  const double flat = lm * double(luminance(p.mean_radiance)) * double(p.area);
  if (p.shape == PrimitiveShape::sphere) return flat / 4;  // cross-section
  const double cosine = dot(Vec3d(p.normal), w);
  return flat * (p.is_two_sided ? std::abs(cosine) : std::max(0.0, cosine));
}

double web_intensity(const Scene& scene, const Light& e, const Vec3d& w) {
  const double lm = scene.is_photometric ? 1 : luminous_efficacy;
  const Vec3d own{dot(Vec3d(e.axes[0]), w), dot(Vec3d(e.axes[1]), w), dot(Vec3d(e.axes[2]), w)};
  return lm * double(luminance(e.radiance)) *
         double(intensity(scene.webs[size_t(e.web)], Vec3(own)));
}

PolarCurve curve_of(const PreparedScene& scene, const LightPieces& pieces,
                    const std::array<Vec3d, 3>& axes) {
  PolarCurve c;
  const Light& first = scene.scene.lights[scene.primitives[pieces[0]].light];
  for (size_t plane = 0; plane < 2; ++plane)
    for (int i = 0; i < PolarCurve::steps; ++i) {
      const double angle = rad_from_deg(5.0 * i - 180);
      const Vec3d w = axes[2] * std::cos(angle) + axes[plane] * std::sin(angle);
      double sum = first.web >= 0 ? web_intensity(scene.scene, first, w) : 0;
      for (const uint32_t k : pieces) sum += intensity_of(scene.scene, scene.primitives[k], w);
      c.candela[plane][size_t(i)] = sum;
    }
  return c;
}

// Direction in which a luminaire aims: its nadir, its beam or its mean normal; zero if it has none.
Vec3d aim_of(const PreparedScene& scene, const LightPieces& pieces) {
  const Light& e = scene.scene.lights[scene.primitives[pieces[0]].light];
  if (e.web >= 0) return Vec3d(e.axes[2]);
  if (e.kind == LightKind::spot) return Vec3d(e.direction);
  Vec3d sum;
  double area = 0;
  for (const uint32_t k : pieces) {
    const LightPrimitive& p = scene.primitives[k];
    if (!p.has_surface() || p.shape == PrimitiveShape::sphere || p.is_two_sided) return {};
    sum += Vec3d(p.normal) * double(p.area);
    area += double(p.area);
  }
  return area > 0 && length(sum) > 0.5 * area ? normalize(sum) : Vec3d{};
}

std::string product_of(const Scene& scene, const Light& e,
                       const std::map<std::string, std::string>& products) {
  if (e.web >= 0) {
    const std::string& file = scene.webs[size_t(e.web)].name;
    const auto at = products.find(file);
    if (at != products.end() && !at->second.empty()) return at->second;
    return file.substr(file.find_last_of("/\\") + 1);
  }
  switch (e.kind) {
    case LightKind::point:
      return "point source";
    case LightKind::spot:
      return fmt::format("spotlight, {:.0f}°",
                         2 * deg_from_rad(std::acos(std::clamp(double(e.cos_outer), -1.0, 1.0))));
    case LightKind::sphere:
      return "diffuse sphere";
    case LightKind::disk:
      return "diffuse disc";
    case LightKind::polygon:
    case LightKind::mesh:
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      break;
  }
  return "diffuse surface";
}

std::optional<double> watts_of(const std::string& name, const std::vector<PowerRequest>& power) {
  std::optional<double> watts;
  for (const PowerRequest& r : power)
    if (fits_wildcard(name, r.name)) watts = r.watts;
  return watts;
}

PlacedLuminaire placed(const PreparedScene& scene, const LightPieces& pieces) {
  const double lm = scene.scene.is_photometric ? 1 : luminous_efficacy;
  PlacedLuminaire l;
  Vec3d sum;
  double weight = 0;
  for (const uint32_t k : pieces) {
    const LightPrimitive& p = scene.primitives[k];
    const double w = std::max(double(p.area), 1e-12);
    sum += Vec3d(p.centroid) * w;
    weight += w;
    l.lumens += double(p.power) * lm;
  }
  l.position = sum * (1 / weight) + scene.scene.origin;
  l.aim = aim_of(scene, pieces);
  const Light& e = scene.scene.lights[scene.primitives[pieces[0]].light];
  const Framed frame(length(l.aim) > 0 ? l.aim : Vec3d{0, 0, -1});
  const std::array<Vec3d, 3> axes =
      e.web >= 0
          ? std::array{Vec3d(e.axes[0]), Vec3d(e.axes[1]), Vec3d(e.axes[2])}
          : std::array{frame.tangent, frame.bitangent, length(l.aim) > 0 ? l.aim : Vec3d{0, 0, -1}};
  l.curve = curve_of(scene, pieces, axes);
  return l;
}

}  // namespace

double PolarCurve::largest() const {
  double most = 0;
  for (const auto& plane : candela)
    most = std::max(most, *std::max_element(plane.begin(), plane.end()));
  return most;
}

std::map<std::string, std::vector<LightPieces>> luminaire_parts(const PreparedScene& scene) {
  std::map<std::string, LightPieces> luminaires;
  for (uint32_t i = 0; i < scene.scene.lights.size(); ++i) {
    const Light& e = scene.scene.lights[i];
    if (is_daylight(e)) continue;
    const LightPrimitives::Range range = scene.primitives.of_light(i);
    for (uint32_t k = range.first; k < range.last; ++k) luminaires[e.name].push_back(k);
  }
  std::map<std::string, std::vector<LightPieces>> parts;
  for (const auto& [name, pieces] : luminaires) parts[name] = connected(scene.primitives, pieces);
  return parts;
}

std::vector<PlacedLuminaire> placed_luminaires(const PreparedScene& scene,
                                               const std::vector<PowerRequest>& power,
                                               const std::map<std::string, std::string>& products) {
  std::vector<PlacedLuminaire> list;
  for (const auto& [name, parts] : luminaire_parts(scene)) {
    const std::optional<double> watts = watts_of(name, power);
    for (const LightPieces& pieces : parts) {
      PlacedLuminaire l = placed(scene, pieces);
      l.name = name;
      l.product =
          product_of(scene.scene, scene.scene.lights[scene.primitives[pieces[0]].light], products);
      if (watts) l.watts = *watts / double(parts.size());
      list.push_back(std::move(l));
    }
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const PlacedLuminaire& a, const PlacedLuminaire& b) {
                     return natural_less(a.name, b.name);
                   });
  return list;
}

}  // namespace troffer
