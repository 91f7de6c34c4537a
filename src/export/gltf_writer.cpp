#include "export/gltf_writer.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/frame.h"
#include "base/units.h"
#include "export/gltf_materials.h"
#include "export/scene_parts.h"
#include "export/vertex_colors.h"
#include "scene/rotation_to_y.h"

namespace troffer {

namespace {

using Json = GltfBuffer::Json;

constexpr uint64_t max_bytes = 0xfffffff0u;

class GltfWriter {
 public:
  GltfWriter(const Scene& scene, const Vec3& up, const BakedLight* baked)
      : scene_(scene),
        up_(up),
        baked_(baked),
        unit_(scene.is_photometric ? 1 : luminous_efficacy),
        materials_(scene, buffer_, unit_, baked, warnings_) {}
  std::vector<Warning> write(const std::string& path, OutputFolder& files);

 private:
  const Scene& scene_;
  const Vec3 up_;
  const BakedLight* baked_;  // may be null
  double unit_;              // cd/m² per unit of the scene's radiance
  WarningLog warnings_;
  GltfBuffer buffer_;
  GltfMaterialWriter materials_;
  Json nodes_ = Json::array(), meshes_ = Json::array(), cameras_ = Json::array(),
       lights_ = Json::array();

  void add_part(const ScenePart& part, Rgb radiance);
  // Data shared by all instances of a mesh.
  struct Primitive {
    Json json;
    uint32_t material = 0;
    int sets = 0;  // number of texture coordinate sets
    int32_t vertex_colors = no_texture;
    std::vector<TextureValue> colors;  // per vertex
  };
  Primitive primitive_of(Mesh mesh, const Light* light);
  void add_colors(const Primitive& p, const BakedSurface* baked, Json& attributes);
  void add_mesh(Primitive primitive, const Light* light, Rgb radiance, const BakedSurface* baked);
  void add_instances();
  void add_node(const std::string& name, Json node);
  void add_light(const Light& e);
  void add_camera(const Camera& c);
  Json file();
  void write_glb(const std::string& path, OutputFolder& files, Json json);
  void write_text(OutputFolder& files, Json json);
};

// Returns a column-major matrix from the images of the axes and of the origin.
template <class T>
Json matrix(const Vec3T<T>& x, const Vec3T<T>& y, const Vec3T<T>& z, const Vec3T<T>& at) {
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, at.x, at.y, at.z, 1};
}

void GltfWriter::add_node(const std::string& name, Json node) {
  if (!name.empty()) node["name"] = name;
  nodes_.push_back(std::move(node));
}

// Returns the mesh with vertex colours instead of the image that contains them.
GltfWriter::Primitive GltfWriter::primitive_of(Mesh m, const Light* light) {
  Primitive out;
  out.vertex_colors = vertex_color_texture(scene_, m);
  if (out.vertex_colors != no_texture) {
    out.colors = colors_of_vertices(scene_, m, out.vertex_colors);
    const Material rest =
        without_vertex_colors(scene_, scene_.materials[m.material], out.vertex_colors);
    if (!uses_uv_set(scene_, rest, light, true)) m.uvs_2.clear();
    if (!uses_uv_set(scene_, rest, light, false) && m.uvs_2.empty()) m.uvs.clear();
  }
  Json attributes{{"POSITION", buffer_.add(m.positions, true)}};
  if (!m.normals.empty()) attributes["NORMAL"] = buffer_.add(m.normals, false);
  if (!m.uvs.empty()) attributes["TEXCOORD_0"] = buffer_.add(m.uvs);
  if (!m.uvs_2.empty()) attributes["TEXCOORD_1"] = buffer_.add(m.uvs_2);
  const size_t indices = buffer_.add(m.triangles);
  out.json = {{"attributes", attributes}, {"indices", indices}};
  out.material = m.material;
  out.sets = m.uvs_2.empty() ? (m.uvs.empty() ? 0 : 1) : 2;
  return out;
}

// Adds vertex colours times baked light. Pages of pictures already contain the colours.
void GltfWriter::add_colors(const Primitive& p, const BakedSurface* baked, Json& attributes) {
  const bool has_light = baked && !baked->colors.empty();
  const bool is_in_page = baked && baked->page >= 0 && baked_->shading == BakedShading::unlit;
  if ((p.colors.empty() || is_in_page) && !has_light) return;
  const size_t n = p.colors.empty() ? baked->colors.size() : p.colors.size();
  std::vector<Vec3> colors;
  std::vector<float> alphas;
  bool has_alpha = false;
  for (size_t i = 0; i < n; ++i) {
    const TextureValue own = p.colors.empty() ? TextureValue() : p.colors[i];
    const Rgb c = has_light ? own.rgb * baked->colors[i] : own.rgb;
    colors.emplace_back(c.r, c.g, c.b);
    alphas.push_back(own.alpha);
    has_alpha = has_alpha || own.alpha < 1;
  }
  attributes["COLOR_0"] = has_alpha ? buffer_.add(colors, alphas) : buffer_.add(colors, false);
}

void GltfWriter::add_mesh(Primitive primitive, const Light* light, Rgb radiance,
                          const BakedSurface* baked) {
  if (baked && !baked->is_baked()) baked = nullptr;
  GltfPlace place;
  place.vertex_colors = primitive.vertex_colors;
  Json& attributes = primitive.json["attributes"];
  if (baked && baked->page >= 0) {
    const size_t uvs = buffer_.add(baked->uvs);
    // Sets are numbered without gaps: a mesh without coordinates gets the page's twice.
    if (primitive.sets == 0) attributes["TEXCOORD_0"] = uvs;
    place.page = baked->page;
    place.set = primitive.sets == 2 ? 2 : 1;
    attributes[place.set == 1 ? "TEXCOORD_1" : "TEXCOORD_2"] = uvs;
  } else if (baked) {
    place.has_light_colors = true;
  }
  add_colors(primitive, baked, attributes);
  primitive.json["material"] = materials_.index_of(primitive.material, light, radiance, place);
  Json mesh;
  mesh["primitives"] = Json::array({std::move(primitive.json)});
  meshes_.push_back(std::move(mesh));
}

void GltfWriter::add_part(const ScenePart& part, Rgb radiance) {
  const Light* light = part.light >= 0 ? &scene_.lights[size_t(part.light)] : nullptr;
  const BakedSurface* baked =
      baked_ && part.number != no_mesh ? &baked_->meshes[part.number] : nullptr;
  add_mesh(primitive_of(part.mesh, light), light, radiance, baked);
  add_node(light ? light->name : part.mesh.name, {{"mesh", meshes_.size() - 1}});
}

// Adds one node per instance. Instances share a mesh, or only its data if each has its own baked
// light.
void GltfWriter::add_instances() {
  const size_t first = meshes_.size();
  std::vector<Primitive> shared;
  for (const Mesh& mesh : scene_.instanced_meshes) {
    shared.push_back(primitive_of(mesh, nullptr));
    if (!baked_) add_mesh(shared.back(), nullptr, {}, nullptr);
  }
  for (const Instance& i : scene_.instances) {
    const Affine& m = i.world_from_mesh;
    size_t mesh = first + i.mesh;
    if (baked_) {
      const auto number = size_t(&i - scene_.instances.data());
      add_mesh(shared[i.mesh], nullptr, {}, &baked_->instances[number]);
      mesh = meshes_.size() - 1;
    }
    add_node(i.name, {{"mesh", mesh},
                      {"matrix", matrix(m.columns[0], m.columns[1], m.columns[2], m.translation)}});
  }
}

void GltfWriter::add_light(const Light& e) {
  Json light;
  switch (e.kind) {
    case LightKind::distant:
    case LightKind::sun:
      light["type"] = "directional";
      break;
    case LightKind::point:
    case LightKind::spot:
      light["type"] = e.kind == LightKind::point ? "point" : "spot";
      break;
    case LightKind::environment:
    case LightKind::sky:
      warnings_.add(std::string("a light of kind '") + name_of(e.kind) +
                    "' is left out: glTF has none (see --sky, --environment)");
      return;
    case LightKind::polygon:
    case LightKind::disk:
    case LightKind::sphere:
    case LightKind::mesh:
      return;  // written with its surface
  }
  if (e.range > 0) light["range"] = e.range;
  if (e.focal_distance > 0)
    warnings_.add("the focal distance of spotlights is left out: glTF has none");
  if (!e.portal.empty()) warnings_.add("portals of suns are left out: glTF has none");
  if (e.texture >= 0)
    warnings_.add("pictures that points and spots project are left out: they shine uniformly");
  Rgb radiance = e.radiance;
  if (e.kind == LightKind::sun) {
    radiance *= float(pi * sqr(std::sin(double(e.angular_radius))));
    warnings_.add("the sun's disc is written as a directional light of the same illuminance");
  }
  if (e.kind == LightKind::spot) {
    light["spot"] = {{"innerConeAngle", std::acos(std::min(1.0, double(e.cos_inner)))},
                     {"outerConeAngle", std::min(pi / 2, std::acos(double(e.cos_outer)))}};
    if (e.falloff != SpotFalloff::square)
      warnings_.add("glTF spots fade quadratically between their angles");
    if (e.cos_outer < 0) warnings_.add("glTF spots are at most 90 degrees wide to each side");
  }
  const float largest = std::max(max_component(radiance), 1e-30f);
  const Rgb color = radiance / largest;
  light["color"] = {color.r, color.g, color.b};
  light["intensity"] = double(largest) * unit_;
  lights_.push_back(std::move(light));
  const Frame f(-e.direction);
  Json node{{"matrix", matrix(f.tangent, f.bitangent, f.normal, e.position)}};
  node["extensions"]["KHR_lights_punctual"]["light"] = lights_.size() - 1;
  add_node(e.name, std::move(node));
}

void GltfWriter::add_camera(const Camera& any) {
  if (any.kind == CameraKind::fisheye)
    warnings_.add("glTF has no fisheye cameras: they are written as perspectives");
  const Camera c = without_fisheye(any);
  const double aspect = c.width > 0 ? double(c.width) / c.height : double(c.aspect);
  double half = double(c.half_extent);
  if (!c.fov_is_vertical && aspect > 0 && aspect < 1) half /= aspect;
  if (c.has_screen_window) {
    const auto& w = c.screen_window;
    if (std::abs(w[0] + w[1]) > 1e-4f * w[1] || std::abs(w[2] + w[3]) > 1e-4f * w[3])
      warnings_.add("glTF cameras have no screen window: it is centred");
    half = double(c.half_extent) * double(w[3] - w[2]) / 2;
  }
  if (c.lens_radius > 0) warnings_.add("glTF cameras have no lens: everything is in focus");
  Json camera;
  if (c.kind == CameraKind::perspective) {
    camera["type"] = "perspective";
    camera["perspective"] = {{"yfov", 2 * std::atan(half)}, {"znear", 1e-3}};
    if (aspect > 0) camera["perspective"]["aspectRatio"] = aspect;
  } else {
    camera["type"] = "orthographic";
    camera["orthographic"] = {
        {"xmag", half * (aspect > 0 ? aspect : 1)}, {"ymag", half}, {"zfar", 1e6}, {"znear", 0}};
  }
  cameras_.push_back(std::move(camera));
  add_node(c.name, {{"camera", cameras_.size() - 1},
                    {"matrix", matrix(c.right, c.up, -c.forward, c.position)}});
}

Json GltfWriter::file() {
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "troffer"}};
  if (baked_)
    for (const auto& [name, value] : baked_->notes)
      json["asset"]["extras"][name] = Json::parse(value);
  json["scene"] = 0;
  Json top = Json::array();
  for (size_t i = 0; i < nodes_.size(); ++i) top.push_back(i);
  const std::array<Vec3d, 3> turn = rotation_to_y(up_);
  const bool is_turned = turn[1] != Vec3d{0, 1, 0};
  if (scene_.origin != Vec3d{} || is_turned) {
    // A top node turns the scene so that y is up, and moves it by its origin.
    const Vec3d& o = scene_.origin;
    const Vec3d at = turn[0] * o.x + turn[1] * o.y + turn[2] * o.z;
    nodes_.push_back(is_turned ? Json{{"matrix", matrix(turn[0], turn[1], turn[2], at)}}
                               : Json{{"translation", {o.x, o.y, o.z}}});
    nodes_.back()["children"] = top;
    top = Json::array({nodes_.size() - 1});
  }
  if (is_turned && !nodes_.empty())
    warnings_.add("glTF's y is up, so the scene is turned: " + describe_turn(turn));
  json["scenes"] = Json::array({Json{{"nodes", top}}});
  for (const auto& [name, rows] : {std::pair<const char*, const Json&>{"nodes", nodes_},
                                   {"meshes", meshes_},
                                   {"cameras", cameras_}})
    if (!rows.empty()) json[name] = rows;
  if (nodes_.empty()) json["scenes"][0].erase("nodes");
  materials_.finish(json);
  if (!buffer_.accessors().empty()) json["accessors"] = buffer_.accessors();
  if (!buffer_.views().empty()) json["bufferViews"] = buffer_.views();
  if (!lights_.empty()) json["extensions"]["KHR_lights_punctual"]["lights"] = lights_;
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  Json used = Json::array();
  for (const char* name :
       {"KHR_lights_punctual", "KHR_materials_anisotropy", "KHR_materials_clearcoat",
        "KHR_materials_emissive_strength", "KHR_materials_diffuse_transmission",
        "KHR_materials_ior", "KHR_materials_iridescence", "KHR_materials_sheen",
        "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_unlit",
        "KHR_materials_volume", "KHR_texture_transform", "MOZ_lightmap"})
    if (text.find(std::string("\"") + name + "\"") != std::string::npos) used.push_back(name);
  if (!used.empty()) json["extensionsUsed"] = used;
  return json;
}

void append_number(std::string& to, uint32_t n) {
  for (int i = 0; i < 4; ++i) to += char((n >> (8 * i)) & 255);
}

// [1] §4.4: a header, the JSON padded with blanks, and the data padded with zeros.
void GltfWriter::write_glb(const std::string& path, OutputFolder& files, Json json) {
  std::vector<uint8_t> data = buffer_.bytes();
  data.resize((data.size() + 3) / 4 * 4);
  if (!data.empty()) json["buffers"] = Json::array({Json{{"byteLength", buffer_.bytes().size()}}});
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const uint64_t size = 20 + text.size() + (data.empty() ? 0 : 8 + uint64_t(data.size()));
  if (size > max_bytes)
    throw EnvironmentError("cannot write " + path + ": it would be above 4 GiB");
  std::string head = "glTF";
  append_number(head, 2);
  append_number(head, uint32_t(size));
  append_number(head, uint32_t(text.size()));
  head += "JSON" + text;
  if (!data.empty()) {
    append_number(head, uint32_t(data.size()));
    head += std::string("BIN\0", 4);
  }
  std::vector<uint8_t> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  files.finish(bytes);
}

void GltfWriter::write_text(OutputFolder& files, Json json) {
  if (!buffer_.bytes().empty()) {
    const std::string uri = uri_of(files.write("data.bin", buffer_.bytes()));
    json["buffers"] = Json::array({Json{{"uri", uri}, {"byteLength", buffer_.bytes().size()}}});
  }
  files.finish(json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<Warning> GltfWriter::write(const std::string& path, OutputFolder& files) {
  if (!scene_.spheres.empty() || !scene_.disks.empty())
    warnings_.add("spheres and disks are written as triangles; sources keep their power");
  const SceneParts parts = parts_of(scene_, true);
  for (const ScenePart& part : parts.parts)
    add_part(part, part.light >= 0 ? parts.radiances[size_t(part.light)] : Rgb{});
  add_instances();
  for (const Light& e : scene_.lights) add_light(e);
  for (const Camera& c : scene_.cameras) add_camera(c);
  Json json = file();
  if (std::filesystem::path(path).extension() == ".glb")
    write_glb(path, files, std::move(json));
  else
    write_text(files, std::move(json));
  return warnings_.entries();
}

}  // namespace

std::vector<Warning> write_gltf(const Scene& scene, const Vec3& up, const std::string& path,
                                OutputFolder& files, const BakedLight* baked) {
  return GltfWriter(scene, up, baked).write(path, files);
}

}  // namespace troffer
