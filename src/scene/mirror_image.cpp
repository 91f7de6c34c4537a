#include "scene/mirror_image.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/frame.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

enum class Side : uint8_t { front, behind, both };

Side side_of(const FlatMirror& m, float least, float most) {
  if (most <= m.tolerance) return Side::behind;
  return least >= -m.tolerance ? Side::front : Side::both;
}

// The part of a mesh in front of the mirror's plane.
struct CutMesh {
  Mesh mesh;  // same material; without lights and normals
  // index here of each triangle of the whole mesh; -1 if cut or behind
  std::vector<int32_t> triangle;
};

class MeshCutter {
 public:
  MeshCutter(const Mesh& mesh, const FlatMirror& mirror) : mesh_(mesh), mirror_(mirror) {
    above_.reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) above_.push_back(mirror.above(p));
    number_.assign(mesh.positions.size(), none);
    out_.mesh.name = mesh.name;
    out_.mesh.material = mesh.material;
    out_.triangle.assign(mesh.triangles.size(), -1);
  }

  CutMesh run() {
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      const auto [least, most] = std::minmax({above_[t[0]], above_[t[1]], above_[t[2]]});
      const Side side = side_of(mirror_, least, most);
      if (side == Side::behind) continue;
      if (side == Side::both) {
        cut(t);
        continue;
      }
      out_.triangle[i] = int32_t(out_.mesh.triangles.size());
      out_.mesh.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
    }
    return std::move(out_);
  }

 private:
  static constexpr uint32_t none = 0xffffffffu;

  uint32_t add(const Vec3& p, const Vec2& uv, const Vec2& uv_2) {
    out_.mesh.positions.push_back(p);
    if (!mesh_.uvs.empty()) out_.mesh.uvs.push_back(uv);
    if (!mesh_.uvs_2.empty()) out_.mesh.uvs_2.push_back(uv_2);
    return uint32_t(out_.mesh.positions.size() - 1);
  }
  Vec2 uv(uint32_t v) const { return mesh_.uvs.empty() ? Vec2{} : mesh_.uvs[v]; }
  Vec2 uv_2(uint32_t v) const { return mesh_.uvs_2.empty() ? Vec2{} : mesh_.uvs_2[v]; }
  uint32_t vertex(uint32_t v) {
    if (number_[v] == none) number_[v] = add(mesh_.positions[v], uv(v), uv_2(v));
    return number_[v];
  }
  // Vertex where an edge crosses the plane, shared by both triangles of the edge.
  uint32_t crossing(uint32_t a, uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [it, is_new] = crossings_.try_emplace({low, high}, 0);
    if (is_new) {
      const float s = above_[low] / (above_[low] - above_[high]);
      it->second =
          add(mesh_.positions[low] + (mesh_.positions[high] - mesh_.positions[low]) * s,
              uv(low) + (uv(high) - uv(low)) * s, uv_2(low) + (uv_2(high) - uv_2(low)) * s);
    }
    return it->second;
  }
  void cut(const Triangle& t) {
    std::array<uint32_t, 4> corners{};
    size_t n = 0;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3];
      if (above_[a] >= 0) corners[n++] = vertex(a);
      if ((above_[a] >= 0) != (above_[b] >= 0)) corners[n++] = crossing(a, b);
    }
    for (size_t k = 2; k < n; ++k)
      out_.mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }

  const Mesh& mesh_;
  const FlatMirror& mirror_;
  std::vector<float> above_;
  std::vector<uint32_t> number_;  // index in the part, by vertex
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> crossings_;
  CutMesh out_;
};

// Builds the mirror image of a scene, one kind of content after the other.
class ImageMaker {
 public:
  ImageMaker(const Scene& scene, const FlatMirror& mirror, const std::vector<bool>& is_left_out)
      : scene_(scene), mirror_(mirror), is_left_out_(is_left_out) {
    out_.scene.file = scene.file;
    out_.scene.origin = scene.origin;
    out_.scene.webs = scene.webs;
    out_.scene.environments = scene.environments;
    out_.scene.is_photometric = scene.is_photometric;
  }

  std::optional<MirrorImage> run() {
    add_materials();
    add_meshes();
    if (!add_spheres() || !add_disks()) return std::nullopt;
    add_lights_without_surface();
    add_wall();
    add_textures();
    return std::move(out_);
  }

 private:
  void add_materials();
  void add_textures();
  void add_meshes();
  void add_mesh_image(const Mesh& whole, const CutMesh& front);
  void add_cut(const Mesh& mesh);
  void add_instances();
  template <class Shape, class Reflect>
  bool add_round(const Shape& shape, float reach, std::vector<Shape>& out, const Reflect& reflect);
  bool add_spheres();
  bool add_disks();
  void add_lights_without_surface();
  void add_wall();
  void add_quad(uint32_t material, const std::array<Vec3, 4>& corners);
  int32_t light_of_image(uint32_t light, uint32_t geometry, const CutMesh* front);
  uint32_t black() const { return uint32_t(scene_.materials.size()); }
  uint32_t pane() const { return black() + 1; }

  const Scene& scene_;
  const FlatMirror& mirror_;
  const std::vector<bool>& is_left_out_;
  MirrorImage out_;
  std::map<uint32_t, int32_t> lights_;  // scene light with a surface -> image light, or no_light
};

bool is_clear(const Material& m) {
  return m.kind == MaterialKind::dielectric || m.kind == MaterialKind::angular ||
         (m.kind == MaterialKind::metallic_roughness && m.transmission.value > 0);
}

// Makes all materials black. Glass is kept, because panes pass light, and so is coverage.
void ImageMaker::add_materials() {
  Material dark;
  dark.base_color = {Rgb{0}, no_texture};
  for (const Material& m : scene_.materials) {
    Material& copy = out_.scene.materials.emplace_back(is_clear(m) ? m : dark);
    copy.normal_texture = no_texture;
    copy.is_alpha_masked = m.is_alpha_masked;
    copy.is_alpha_blended = m.is_alpha_blended;
    copy.alpha = m.alpha;
    copy.alpha_cutoff = m.alpha_cutoff;
  }
  out_.scene.materials.push_back(dark);
  Material pane = mirror_.relayed ? Material() : scene_.materials[mirror_.material];
  if (mirror_.relayed) {  // glass of index 1, whose tint is the same at every angle
    pane.kind = MaterialKind::metallic_roughness;
    pane.base_color.value = *mirror_.relayed;
    pane.metallic.value = 0;
    pane.transmission.value = 1;
    pane.is_thin = true;
    pane.ior = 1;
  } else {
    pane.is_mirror_pane = true;
  }
  out_.scene.materials.push_back(std::move(pane));
}

// Copies only the textures that the image still uses.
void ImageMaker::add_textures() {
  const std::vector<Texture>& all = scene_.textures;
  std::vector<bool> is_used(all.size(), false);
  const auto use = [&](int32_t t) {
    if (t >= 0) is_used[size_t(t)] = true;
  };
  for (const Material& m : out_.scene.materials) {
    for_each_input(m, [&](const auto& input) { use(input.texture); });
    if (m.is_alpha_masked) use(m.alpha.texture);
  }
  for (const Light& e : out_.scene.lights) use(e.texture);
  // Operands stand before the textures that use them.
  for (size_t t = all.size(); t-- > 0;) {
    if (!is_used[t]) continue;
    if (all[t].kind == TextureKind::product)
      is_used[all[t].factor_a] = is_used[all[t].factor_b] = true;
    for (const TextureOperand* o : {&all[t].first, &all[t].second, &all[t].amount}) use(o->texture);
  }
  out_.scene.textures.resize(all.size());
  for (size_t t = 0; t < all.size(); ++t)
    if (is_used[t]) out_.scene.textures[t] = all[t];
}

// Returns the index of a light's image, or no_light. `front` is the light's mesh, cut at the plane.
int32_t ImageMaker::light_of_image(uint32_t light, uint32_t geometry, const CutMesh* front) {
  const auto [it, is_new] = lights_.try_emplace(light, no_light);
  if (!is_new) return it->second;
  Light image = scene_.lights[light];
  image.geometry = geometry;
  for (uint32_t& t : image.triangles) {
    const int32_t number = front->triangle[t];
    if (number < 0) return no_light;
    t = uint32_t(number);
  }
  for (Vec3& p : image.polygon) p = mirror_.reflected(p);
  std::reverse(image.polygon.begin(), image.polygon.end());
  it->second = int32_t(out_.scene.lights.size());
  out_.scene.lights.push_back(std::move(image));
  out_.lights.push_back(light);
  return it->second;
}

void ImageMaker::add_mesh_image(const Mesh& whole, const CutMesh& front) {
  const auto number = uint32_t(out_.scene.meshes.size());
  Mesh image = front.mesh;
  for (Vec3& p : image.positions) p = mirror_.reflected(p);
  for (Triangle& t : image.triangles) std::swap(t[1], t[2]);
  if (!whole.lights.empty()) {
    image.lights.assign(image.triangles.size(), no_light);
    for (size_t t = 0; t < whole.lights.size(); ++t)
      if (whole.lights[t] >= 0 && front.triangle[t] >= 0)
        image.lights[size_t(front.triangle[t])] =
            light_of_image(uint32_t(whole.lights[t]), number, &front);
  }
  out_.scene.meshes.push_back(std::move(image));
}

void ImageMaker::add_cut(const Mesh& mesh) {
  CutMesh front = MeshCutter(mesh, mirror_).run();
  if (front.mesh.triangles.empty()) return;
  add_mesh_image(mesh, front);
  out_.scene.meshes.push_back(std::move(front.mesh));
}

// Instances that the plane cuts are copied to meshes.
void ImageMaker::add_instances() {
  out_.scene.instanced_meshes = scene_.instanced_meshes;
  for (Mesh& mesh : out_.scene.instanced_meshes) mesh.normals = {};
  const Affine reflection = mirror_.reflection();
  for (const Instance& i : scene_.instances) {
    const auto [least, most] = mirror_.heights(i.bounds);
    const Side side = side_of(mirror_, least, most);
    if (side == Side::behind) continue;
    if (side == Side::both) {
      add_cut(copied_to_world(MeshInWorld(out_.scene.instanced_meshes[i.mesh], &i)));
      continue;
    }
    const Mesh& mesh = out_.scene.instanced_meshes[i.mesh];
    const Affine image = reflection * i.world_from_mesh;
    out_.scene.instances.push_back(
        make_instance(i.mesh, image, i.name, reach_of(mesh), bounds_in_world(mesh, image)));
    out_.scene.instances.push_back(i);
  }
}

void ImageMaker::add_meshes() {
  for (const Mesh& mesh : scene_.meshes) add_cut(mesh);
  add_instances();
}

// Adds a sphere or disk that extends `reach` from its centre along the normal. Returns false if it
// crosses the plane.
template <class Shape, class Reflect>
bool ImageMaker::add_round(const Shape& shape, float reach, std::vector<Shape>& out,
                           const Reflect& reflect) {
  const float height = mirror_.above(shape.centre);
  const Side side = side_of(mirror_, height - reach, height + reach);
  if (side == Side::both) return false;
  if (side == Side::behind) return true;
  Shape image = shape;
  image.centre = mirror_.reflected(shape.centre);
  reflect(image);
  if (shape.light >= 0)
    image.light = light_of_image(uint32_t(shape.light), uint32_t(out.size()), nullptr);
  out.push_back(image);
  out.push_back(shape);
  out.back().light = no_light;
  return true;
}

bool ImageMaker::add_spheres() {
  for (const Sphere& s : scene_.spheres)
    if (!add_round(s, s.radius, out_.scene.spheres, [](Sphere&) {})) return false;
  return true;
}

bool ImageMaker::add_disks() {
  for (const Disk& d : scene_.disks) {
    const float cosine = dot(d.normal, mirror_.normal);
    const float reach = d.radius * std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const auto turn = [&](Disk& image) { image.normal = mirror_.reflected_direction(d.normal); };
    if (!add_round(d, reach, out_.scene.disks, turn)) return false;
  }
  return true;
}

void ImageMaker::add_lights_without_surface() {
  for (uint32_t l = 0; l < scene_.lights.size(); ++l) {
    const Light& e = scene_.lights[l];
    if (has_surface(e.kind) || (!is_left_out_.empty() && is_left_out_[l])) continue;
    const bool is_placed = e.kind == LightKind::point || e.kind == LightKind::spot;
    if (is_placed && mirror_.above(e.position) <= mirror_.tolerance) continue;
    Light image = e;
    image.position = mirror_.reflected(e.position);
    image.direction = mirror_.reflected_direction(e.direction);
    for (Vec3& axis : image.axes) axis = mirror_.reflected_direction(axis);
    out_.scene.lights.push_back(std::move(image));
    out_.lights.push_back(l);
  }
}

void ImageMaker::add_quad(uint32_t material, const std::array<Vec3, 4>& corners) {
  Mesh& mesh = out_.scene.meshes.emplace_back();
  mesh.material = material;
  mesh.positions.assign(corners.begin(), corners.end());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
}

// Covers the plane except the mirror by one large quad outside each edge of the outline, and
// encloses the front by five sides of a box.
void ImageMaker::add_wall() {
  const std::vector<Vec3>& outline = mirror_.outline;
  Box box = bounds(scene_);
  for (const Vec3& p : outline) box.grow(p);  // no geometry need stand in place of a relay
  const float size = box.diagonal();
  Vec3 middle;
  for (const Vec3& p : outline) middle = middle + p * (1 / float(outline.size()));
  const float reach = 2 * size;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const Vec3 along = normalize(b - a);
    Vec3 out = normalize(cross(along, mirror_.normal));
    if (dot(out, a - middle) < 0) out = -out;
    add_quad(black(), {a - along * reach, b + along * reach, b + along * reach + out * reach,
                       a - along * reach + out * reach});
  }
  Mesh& mirror = out_.scene.meshes.emplace_back();
  mirror.material = pane();
  mirror.positions = outline;
  for (uint32_t i = 2; i < outline.size(); ++i) mirror.triangles.push_back({0, i - 1, i});

  const Frame frame(mirror_.normal);
  const float half = 1.25f * size, low = -1e-3f * size, high = 1.25f * size;
  const auto corner = [&](float x, float y, float z) { return middle + frame.to_world({x, y, z}); };
  for (const float s : {-half, half}) {
    add_quad(black(), {corner(s, -half, low), corner(s, half, low), corner(s, half, high),
                       corner(s, -half, high)});
    add_quad(black(), {corner(-half, s, low), corner(half, s, low), corner(half, s, high),
                       corner(-half, s, high)});
  }
  add_quad(black(), {corner(-half, -half, high), corner(half, -half, high),
                     corner(half, half, high), corner(-half, half, high)});
}

}  // namespace

Affine FlatMirror::reflection() const {
  const Vec3d n(normal);
  Affine a;
  for (size_t k = 0; k < 3; ++k) a.columns[k] = a.columns[k] - n * (2 * n[k]);
  a.translation = n * (2 * double(height));
  return a;
}

std::pair<float, float> FlatMirror::heights(const Box& box) const {
  float least = -height, most = -height;
  for (size_t a = 0; a < 3; ++a) {
    const float p = normal[a] * box.lower[a], q = normal[a] * box.upper[a];
    least += std::min(p, q);
    most += std::max(p, q);
  }
  return {least, most};
}

std::optional<MirrorImage> mirror_image_of(const Scene& scene, const FlatMirror& mirror,
                                           const std::vector<bool>& is_left_out) {
  return ImageMaker(scene, mirror, is_left_out).run();
}

}  // namespace troffer
