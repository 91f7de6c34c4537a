#include "transport/mirror_images.h"

#include <algorithm>
#include <cmath>

#include "base/ablation.h"
#include "base/merge_polygons.h"
#include "base/random.h"
#include "base/streams.h"
#include "light/light.h"
#include "transport/light_tree_direct.h"

namespace troffer {

namespace {

constexpr size_t most_images = 8;
constexpr size_t most_corners = 8;            // per mirror
constexpr size_t most_candidates = 256;       // the largest ones
constexpr size_t most_triangles = 2'000'000;  // in all images together
constexpr size_t points_of_mirror = 64;       // sample points for the flux of a mirror
// at normal incidence; weaker mirrors are left to rays
constexpr float least_reflectance = 0.2f;
constexpr float least_area_of_scene = 1e-4f;  // area of a mirror / squared diagonal of the scene
constexpr float least_share = 1e-3f;          // flux of a mirror / flux of the strongest one

// Mean solid angle from which a light at infinity counts as broad. Of random rays from a matte
// surface, more than one in a hundred meets it.
constexpr double broad = 0.05;  // sr
constexpr uint32_t samples_of_light = 1024;

struct Candidate {
  FlatMirror mirror;
  std::vector<uint32_t> triangles;
  bool is_front = true;
  uint32_t number = 0;  // among all candidates of the mesh: each has its own random numbers
  float area = 0;
  float light = 0;  // reflected flux
};

// Returns the solid angle of the uniform light whose samples have the same mean density, sr: the
// squared integral of the radiance over the integral of its square.
double mean_solid_angle(const PreparedScene& scene, const LightPrimitive& p) {
  const Vec3 middle = bounds(scene.scene).centre();
  double density = 0;
  uint32_t n = 0;
  for (uint32_t i = 0; i < samples_of_light; ++i) {
    const SobolGroup numbers(hash_of(stream::mirror_candidates, p.light), 1, i);
    LightSample s;
    if (!sample(scene.scene, p, middle, numbers.get2(0), s) || !(s.pdf_solid_angle > 0)) continue;
    density += double(s.pdf_solid_angle);
    ++n;
  }
  return n > 0 ? n / density : 0;
}

// Returns, per light, whether it is a broad light at infinity, like a sky. Random rays meet those
// often, by way of mirrors, too. Images would cost proofs and rays for each mirror.
std::vector<bool> broad_lights(const PreparedScene& scene) {
  std::vector<bool> is_broad(scene.scene.lights.size(), false);
  for (size_t i = 0; i < scene.primitives.size(); ++i) {
    const LightPrimitive& p = scene.primitives[i];
    if (p.is_infinite() && !is_delta(scene.scene.lights[p.light].kind))
      is_broad[p.light] = mean_solid_angle(scene, p) > broad;
  }
  return is_broad;
}

// Returns the luminance of the reflectance at normal incidence; 0 if the material cannot have an
// image.
float mirrored_share(const PreparedScene& scene, uint32_t material) {
  const Material& m = scene.scene.materials[material];
  if (has_textured_input(m) || m.normal_texture >= 0 || has_own_coat_normal(m) || m.is_alpha_masked)
    return 0;
  const Bsdf bsdf = make_bsdf(scene.bsdf_tables, scene.scene, material, {}, true);
  if (bsdf.fresnel == Bsdf::Fresnel::none || !bsdf.is_smooth || bsdf.has_transmission) return 0;
  return luminance(mirrored_reflectance(bsdf, 1));
}

// Returns a vector along the normal of the front, whose length is the area.
Vec3 vector_area(const std::vector<Vec3>& outline) {
  Vec3 sum;
  for (size_t i = 2; i < outline.size(); ++i)
    sum = sum + cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
  return sum * 0.5f;
}

// True if shading normals equal the polygon's normal. Others would bend the reflection.
bool is_flat_at(const Mesh& mesh, const Triangle& t, const Vec3& normal) {
  if (mesh.normals.empty()) return true;
  for (const uint32_t v : t)
    if (std::abs(dot(mesh.normals[v], normal)) < 0.99999f * length(mesh.normals[v])) return false;
  return true;
}

void add_polygons(const PreparedScene& scene, uint32_t number, float least_area,
                  std::vector<Candidate>& out) {
  const Mesh& mesh = scene.scene.meshes[number];
  const std::vector<uint32_t> welded = weld(mesh.positions);
  PolygonList pieces;
  for (const Triangle& t : mesh.triangles)
    pieces.add(std::array<uint32_t, 3>{welded[t[0]], welded[t[1]], welded[t[2]]});
  const MergedPolygons merged = merge_polygons(
      mesh.positions, pieces, sorted_edges(pieces, mesh.positions.size()), most_corners);
  // A mesh may have millions of polygons; only large ones are candidates.
  std::vector<int32_t> number_of(merged.polygons.size(), -1);
  std::vector<Candidate> all;
  for (size_t p = 0; p < merged.polygons.size(); ++p) {
    Candidate c;
    for (const uint32_t v : merged.polygons[p]) c.mirror.outline.push_back(mesh.positions[v]);
    const Vec3 area = vector_area(c.mirror.outline);
    c.area = length(area);
    if (!(c.area >= least_area)) continue;
    c.mirror.normal = area * (1 / c.area);
    c.mirror.mesh = number;
    c.mirror.material = mesh.material;
    number_of[p] = int32_t(all.size());
    all.push_back(std::move(c));
  }
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const uint32_t p = merged.of_piece[t];
    if (p != no_polygon && number_of[p] >= 0) all[size_t(number_of[p])].triangles.push_back(t);
  }
  uint32_t count = 0;
  for (Candidate& c : all) {
    bool is_flat = true;
    for (const uint32_t t : c.triangles)
      is_flat = is_flat && is_flat_at(mesh, mesh.triangles[t], c.mirror.normal);
    if (!is_flat) continue;
    c.number = count++;
    out.push_back(c);
    out.push_back(std::move(c));
    out.back().number = count++;
    out.back().is_front = false;
    out.back().mirror.normal = -out.back().mirror.normal;
  }
}

// Sets the mirror's plane and the tolerance for points on it.
void set_plane(const PreparedScene& scene, FlatMirror& m) {
  Vec3 middle;
  for (const Vec3& p : m.outline) middle = middle + p * (1 / float(m.outline.size()));
  m.height = dot(m.normal, middle);
  Box box = bounds(scene.scene);
  for (const Vec3& p : m.outline) box.grow(p);
  float magnitude = 0;
  for (size_t a = 0; a < 3; ++a)
    magnitude = std::max({magnitude, std::abs(box.lower[a]), std::abs(box.upper[a])});
  m.tolerance = 2 * ray_offset(magnitude);
}

// Returns the flux that a mirror reflects, estimated at a few points.
float light_from(const PreparedScene& scene, const Candidate& c, float share) {
  const LightTreeDirect direct(scene);
  WaveHits wave;
  Bsdf white = sensor_bsdf();
  white.diffuse = Rgb{1};
  const std::vector<Vec3>& o = c.mirror.outline;
  for (uint32_t i = 0; i < points_of_mirror; ++i) {
    // sample the outline's triangle fan by area
    const SobolGroup numbers(hash_of(stream::mirror_candidates), 0, i);
    const Vec2 u = numbers.get2(0);
    float at = numbers.get(2) * c.area;
    size_t k = 2;
    for (; k + 1 < o.size(); ++k) {
      const float piece = 0.5f * length(cross(o[k - 1] - o[0], o[k] - o[0]));
      if (at < piece) break;
      at -= piece;
    }
    const float root = std::sqrt(u.x);
    const Vec3 p = o[0] * (1 - root) + (o[k - 1] * (1 - u.y) + o[k] * u.y) * root;
    Walk walk;
    walk.index = i;
    walk.sample = i;
    walk.stream = hash_of(stream::mirror_light, c.mirror.mesh, c.number);
    wave.walks.push_back(walk);
    wave.vertices.push_back(make_sensor_vertex(p, c.mirror.normal, c.mirror.tolerance));
    wave.bsdfs.push_back(white);
  }
  const auto scratch = direct.make_scratch();
  RadianceBatch out;
  out.reset(points_of_mirror);
  Counters counters;
  direct.queue(wave, *scratch, out, counters);
  direct.flush(*scratch, out, counters);
  float sum = 0;
  for (size_t i = 0; i < points_of_mirror; ++i)
    sum += luminance(out.direct[i]) + luminance(out.indirect[i]);
  return std::isfinite(sum) ? sum * c.area * share : 0;
}

std::vector<Candidate> best_of(const PreparedScene& scene, const std::vector<bool>& is_broad) {
  std::vector<Candidate> all;
  bool is_any = false;
  for (size_t i = 0; i < scene.primitives.size(); ++i)
    is_any = is_any || !is_broad[scene.primitives[i].light];
  if (!is_any) return all;
  const float least_area = least_area_of_scene * sqr(bounds(scene.scene).diagonal());
  for (uint32_t m = 0; m < scene.scene.meshes.size(); ++m)
    if (mirrored_share(scene, scene.scene.meshes[m].material) >= least_reflectance)
      add_polygons(scene, m, least_area, all);
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
  all.resize(std::min(all.size(), most_candidates));
  float most = 0;
  for (Candidate& c : all) {
    set_plane(scene, c.mirror);
    c.light = light_from(scene, c, mirrored_share(scene, c.mirror.material));
    most = std::max(most, c.light);
  }
  std::erase_if(all, [&](const Candidate& c) { return !(c.light > least_share * most); });
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.light > b.light; });
  all.resize(std::min(all.size(), most_images));
  return all;
}

}  // namespace

std::shared_ptr<const MirrorImages> MirrorImages::make(const PreparedScene& scene) {
  auto images = std::make_shared<MirrorImages>();
  images->of_triangle_.resize(scene.scene.meshes.size());
  if (scene.primitives.size() == 0) return nullptr;
  if (is_left_out<"mirror images">()) return of_relays(scene);
  images->add_relays(scene);
  const std::vector<bool> is_broad = broad_lights(scene);
  size_t triangles = 0;
  for (Candidate& c : best_of(scene, is_broad)) {
    std::optional<MirrorImage> made = mirror_image_of(scene.scene, c.mirror, is_broad);
    if (!made || made->lights.empty()) continue;
    triangles += triangle_count(made->scene);
    if (triangles > most_triangles) break;
    auto& of_triangle = images->of_triangle_[c.mirror.mesh];
    of_triangle.resize(scene.scene.meshes[c.mirror.mesh].triangles.size(), {-1, -1});
    for (const uint32_t t : c.triangles)
      of_triangle[t][c.is_front ? 0 : 1] = int32_t(images->images_.size());
    images->add(scene, c.mirror, std::move(*made));
  }
  if (images->images_.empty()) return nullptr;
  return images;
}

std::shared_ptr<const MirrorImages> MirrorImages::of_relays(const PreparedScene& scene) {
  if (scene.scene.relays.empty() || scene.primitives.size() == 0) return nullptr;
  auto images = std::make_shared<MirrorImages>();
  images->add_relays(scene);
  return images->images_.empty() ? nullptr : images;
}

void MirrorImages::add_relays(const PreparedScene& scene) {
  for (const LightRelay& r : scene.scene.relays) {
    FlatMirror mirror;
    mirror.outline = r.outline;
    mirror.normal = r.normal;
    mirror.relayed = r.reflectance;
    set_plane(scene, mirror);
    std::optional<MirrorImage> made = mirror_image_of(scene.scene, mirror);
    if (made && !made->lights.empty()) add(scene, mirror, std::move(*made));
  }
}

void MirrorImages::add(const PreparedScene& scene, const FlatMirror& mirror, MirrorImage made) {
  Image& image = images_.emplace_back();
  image.mirror = mirror;
  image.shows.assign(scene.scene.lights.size(), false);
  for (const uint32_t l : made.lights) image.shows[l] = true;
  image.scene = std::make_unique<const PreparedScene>(std::move(made.scene));
}

int32_t MirrorImages::at(const Vertex& v) const {
  if (v.surface.geometry >= of_triangle_.size()) return -1;
  const auto& of_triangle = of_triangle_[v.surface.geometry];
  return of_triangle.empty() ? -1 : of_triangle[v.surface.primitive][v.is_front ? 0 : 1];
}

uint32_t MirrorImages::note_beyond(const Vertex& v, uint32_t note, bool is_scattered,
                                   const Vec3& direction) const {
  // True mirror reflection: the walk was neither scattered nor transmitted.
  if (note != note_from_matte || is_scattered) return 0;
  const int32_t image = at(v);
  return image >= 0 && dot(direction, v.geometric_normal) > 0 ? first_image + uint32_t(image) : 0;
}

}  // namespace troffer
