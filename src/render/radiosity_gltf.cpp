#include "render/radiosity_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>

#include "base/random.h"
#include "base/units.h"
#include "radiosity/interpolation.h"

namespace troffer {

namespace {

struct Vertex {
  std::array<uint32_t, 6> bits;  // position and colour
  bool operator==(const Vertex&) const = default;
};
struct VertexHash {
  size_t operator()(const Vertex& v) const {
    uint64_t h = 0;
    for (const uint32_t b : v.bits) h = hash_combine(h, b);
    return size_t(h);
  }
};

// Vertices and indices of a primitive; equal vertices are shared.
class Drawing {
 public:
  void add(const Vec3& position, Rgb colour) {
    const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
    const Vertex v{{bits(position.x), bits(position.y), bits(position.z), bits(colour.r),
                    bits(colour.g), bits(colour.b)}};
    const auto [it, is_new] = known_.try_emplace(v, uint32_t(positions.size()));
    if (is_new) {
      positions.push_back(position);
      colours.push_back(colour);
    }
    indices.push_back(it->second);
  }

  std::vector<Vec3> positions;
  std::vector<Rgb> colours;
  std::vector<uint32_t> indices;

 private:
  std::unordered_map<Vertex, uint32_t, VertexHash> known_;
};

// Returns a colour that is finite and in [0,1], as [1] §3.7.2.1 requires.
Rgb shown(Rgb c) {
  for (size_t i = 0; i < 3; ++i) c[i] = c[i] > 0 ? std::min(c[i], 1.0f) : 0.0f;
  return c;
}

// Returns the light of each fragment's triangle.
std::vector<int32_t> lights_of_fragments(const RadiosityMesh& mesh) {
  std::vector<int32_t> lights(mesh.fragments.size(), no_light);
  std::vector<int32_t> stack;
  for (size_t t = 0; t < mesh.roots.size(); ++t) {
    if (mesh.roots[t] == RadiosityMesh::no_root) continue;
    stack.assign(1, mesh.roots[t]);
    while (!stack.empty()) {
      const int32_t at = stack.back();
      stack.pop_back();
      if (at < 0)
        lights[size_t(~at)] = mesh.geometry.triangles[t].light;
      else
        for (const int32_t child : mesh.nodes[size_t(at)].child) stack.push_back(child);
    }
  }
  return lights;
}

// Returns pi L of the front or the back; textures count as white.
Rgb exitance(const Scene& scene, int32_t light, bool is_back) {
  if (light < 0) return Rgb{0};
  const Light& e = scene.lights[size_t(light)];
  return is_back && !e.is_two_sided ? Rgb{0} : e.radiance * pi_f;
}

Rgb display_irradiance(const RadiositySolution& s, uint32_t point) {
  const Rgb e = s.irradiance(point);
  return e.is_black() ? e : e + s.ambient;
}

// Returns 1 / the radiosity, in the brightest channel, that 95 % of the area do not exceed.
float choose_exposure(const RadiositySolution& s) {
  struct Part {
    float value, area;
  };
  std::vector<Part> parts;
  double area = 0, below = 0;
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i) {
    const ElementPoint& p = s.mesh.points[i];
    const Rgb radiosity = p.reflectance * display_irradiance(s, i);
    const float b = std::max({radiosity.r, radiosity.g, radiosity.b});
    if (!(b > 0)) continue;
    parts.push_back({b, p.area});
    area += double(p.area);
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.value < b.value; });
  for (const Part& p : parts) {
    below += double(p.area);
    if (below >= 0.95 * area) return 1 / p.value;
  }
  return s.mean_irradiance > 0 ? 1 / s.mean_irradiance : 1;
}

Drawing draw_light(const Scene& scene, const RadiositySolution& s, float exposure) {
  const std::vector<int32_t> lights = lights_of_fragments(s.mesh);
  Drawing out;
  Interpolation at;
  for (uint32_t f = 0; f < s.mesh.fragments.size(); ++f) {
    const Fragment& fragment = s.mesh.fragments[f];
    for (uint32_t side = 0; side < 2; ++side) {
      const uint32_t point = s.mesh.element_points[fragment.element][side];
      if (point == no_point) continue;
      const Rgb emitted = exitance(scene, lights[f], side == 1);
      for (size_t k = 0; k < 3; ++k) {
        const size_t corner = side == 1 ? 2 - k : k;
        at.clear();
        interpolate_at_knot(s.mesh, f, corner, side == 1, at);
        Rgb e;
        for (const PointWeight& w : at.weights()) e += display_irradiance(s, w.point) * w.weight;
        const Rgb b = s.mesh.points[point].reflectance * e + emitted;
        out.add(s.mesh.geometry.positions[fragment.vertices[corner]], shown(b * exposure));
      }
    }
  }
  return out;
}

// Draws the outlines of elements, slightly in front of each side.
Drawing draw_elements(const RadiositySolution& s) {
  struct Edge {
    uint32_t a, b, element, fragment;
  };
  const RadiosityMesh& mesh = s.mesh;
  std::vector<Edge> edges;
  for (uint32_t f = 0; f < mesh.fragments.size(); ++f) {
    const auto& v = mesh.fragments[f].vertices;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = v[k], b = v[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), mesh.fragments[f].element, f});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::array{x.a, x.b, x.element, x.fragment} <
           std::array{y.a, y.b, y.element, y.fragment};
  });
  const auto is_same = [](const Edge& x, const Edge& y) {
    return x.a == y.a && x.b == y.b && x.element == y.element;
  };
  Drawing out;
  const float lift = 0.004f * mesh.element_size;
  for (size_t i = 0; i < edges.size(); ++i) {
    const Edge& e = edges[i];
    if ((i > 0 && is_same(edges[i - 1], e)) || (i + 1 < edges.size() && is_same(e, edges[i + 1])))
      continue;  // inside an element
    const Vec3 normal = fragment_normal(mesh, e.fragment) * lift;
    for (uint32_t side = 0; side < 2; ++side) {
      if (mesh.element_points[e.element][side] == no_point) continue;
      for (const uint32_t v : {e.a, e.b})
        out.add(mesh.geometry.positions[v] + (side == 1 ? -normal : normal), Rgb{1});
    }
  }
  return out;
}

template <class T>
void append(std::vector<uint8_t>& out, const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
  out.insert(out.end(), bytes, bytes + values.size() * sizeof(T));
}

// Binary data, and the lists of JSON objects that describe it. All components have four bytes, so
// everything is aligned.
class Buffer {
 public:
  std::string add_positions(const std::vector<Vec3>& p) {
    Box box;
    for (const Vec3& v : p) box.grow(v);
    const auto list = [](const Vec3& v) {
      return fmt::format("[{},{},{}]", double(v.x), double(v.y), double(v.z));
    };
    return add(p, 34962, 5126, "VEC3",
               fmt::format(",\"min\":{},\"max\":{}", list(box.lower), list(box.upper)));
  }
  std::string add_colours(const std::vector<Rgb>& c) { return add(c, 34962, 5126, "VEC3", ""); }
  std::string add_indices(const std::vector<uint32_t>& i) {
    return add(i, 34963, 5125, "SCALAR", "");
  }

  std::vector<uint8_t> bytes;
  std::string views, accessors;

 private:
  template <class T>
  std::string add(const std::vector<T>& values, int target, int component, const char* type,
                  const std::string& limits) {
    const char* comma = count_ > 0 ? ",\n" : "";
    views += fmt::format("{}    {{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":{}}}",
                         comma, bytes.size(), values.size() * sizeof(T), target);
    accessors += fmt::format(
        "{}    {{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"{}\"{}}}", comma,
        count_, component, values.size(), type, limits);
    append(bytes, values);
    return std::to_string(count_++);
  }
  int count_ = 0;
};

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[v >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// Returns the node property that transforms the scene's world into glTF's; empty if they agree.
std::string world_matrix(const Scene& scene) {
  const Vec3d& o = scene.origin;
  const auto translation = [&](const Vec3d& t) {
    return o == Vec3d{} ? "" : fmt::format(",\"translation\":[{},{},{}]", t.x, t.y, t.z);
  };
  if (scene.is_photometric || scene.cameras.empty()) return translation(o);
  const Camera& c = scene.cameras[0];
  const bool is_left_handed = dot(cross(c.right, c.up), c.forward) > 0;
  const bool is_z_up = std::abs(c.up.z) > std::abs(c.up.y);
  if (is_z_up)
    return is_left_handed
               ? fmt::format(",\"matrix\":[1,0,0,0, 0,0,1,0, 0,1,0,0, {},{},{},1]", o.x, o.z, o.y)
               : fmt::format(",\"matrix\":[1,0,0,0, 0,0,-1,0, 0,1,0,0, {},{},{},1]", o.x, o.z,
                             0.0 - o.y);
  return is_left_handed ? ",\"scale\":[1,1,-1]" + translation({o.x, o.y, 0.0 - o.z})
                        : translation(o);
}

std::string mesh_json(Buffer& buffer, const Drawing& drawing, const char* name, int mode,
                      int material) {
  const std::string p = buffer.add_positions(drawing.positions);
  const std::string colours =
      mode == 4 ? ",\"COLOR_0\":" + buffer.add_colours(drawing.colours) : "";
  const std::string i = buffer.add_indices(drawing.indices);
  return fmt::format(
      "    {{\"name\":\"{}\",\"primitives\":[{{\"attributes\":{{\"POSITION\":{}{}}},"
      "\"indices\":{},\"mode\":{},\"material\":{}}}]}}",
      name, p, colours, i, mode, material);
}

std::string material_json(const char* name, const char* colour) {
  return fmt::format(
      "    {{\"name\":\"{}\",\"pbrMetallicRoughness\":{{\"baseColorFactor\":{},"
      "\"metallicFactor\":0,\"roughnessFactor\":1}},\"extensions\":{{\"KHR_materials_unlit\":{{}}}}"
      "}}",
      name, colour);
}

// Fills `buffer`, which the text contains as well if `is_embedded`.
std::string file_json(const Scene& scene, const RadiositySolution& s, bool is_embedded,
                      Buffer& buffer) {
  const float exposure = choose_exposure(s);
  std::string json = fmt::format(
      "{{\n  \"asset\":{{\"version\":\"2.0\",\"generator\":\"troffer\",\"extras\":{{"
      "\"colour\":\"(radiosity + emission) x exposure\",\"exposure\":{},\"elements\":{},"
      "\"patches\":{}}}}},\n",
      double(exposure), s.mesh.element_count, s.mesh.patches.size());
  const Drawing light = draw_light(scene, s, exposure);
  if (light.indices.empty())
    return json + "  \"scene\":0,\n  \"scenes\":[{\"name\":\"light\"}]\n}\n";
  const Drawing lines = draw_elements(s);
  const std::string matrix = world_matrix(scene);
  json += "  \"extensionsUsed\":[\"KHR_materials_unlit\"],\n  \"scene\":0,\n";
  json +=
      "  \"scenes\":[{\"name\":\"light\",\"nodes\":[0]},"
      "{\"name\":\"elements\",\"nodes\":[0,1]}],\n";
  json += fmt::format(
      "  \"nodes\":[{{\"name\":\"light\",\"mesh\":0{}}},{{\"name\":\"elements\",\"mesh\":1{}}}],\n",
      matrix, matrix);
  json += "  \"materials\":[\n" + material_json("light", "[1,1,1,1]") + ",\n" +
          material_json("elements", "[0.02,0.02,0.02,1]") + "\n  ],\n";
  const std::string first = mesh_json(buffer, light, "light", 4, 0);
  json +=
      "  \"meshes\":[\n" + first + ",\n" + mesh_json(buffer, lines, "elements", 1, 1) + "\n  ],\n";
  json += "  \"accessors\":[\n" + buffer.accessors + "\n  ],\n";
  json += "  \"bufferViews\":[\n" + buffer.views + "\n  ],\n";
  json += fmt::format("  \"buffers\":[{{\"byteLength\":{}", buffer.bytes.size());
  if (is_embedded)
    json += ",\"uri\":\"data:application/octet-stream;base64," + base64(buffer.bytes) + "\"";
  json += "}]\n}\n";
  return json;
}

void append_word(std::vector<uint8_t>& out, size_t v) {
  append(out, std::vector<uint32_t>{uint32_t(v)});
}

}  // namespace

std::vector<uint8_t> radiosity_gltf(const Scene& scene, const RadiositySolution& solution,
                                    GltfContainer container) {
  Buffer buffer;
  std::string json = file_json(scene, solution, container == GltfContainer::text, buffer);
  if (container == GltfContainer::text) return {json.begin(), json.end()};
  std::vector<uint8_t> out;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const size_t binary = buffer.bytes.empty() ? 0 : 8 + buffer.bytes.size();
  append_word(out, 0x46546c67);  // [1] §4.4: "glTF", version, length; chunks "JSON" and "BIN"
  append_word(out, 2);
  append_word(out, 12 + 8 + json.size() + binary);
  append_word(out, json.size());
  append_word(out, 0x4e4f534a);
  out.insert(out.end(), json.begin(), json.end());
  if (binary > 0) {
    append_word(out, buffer.bytes.size());
    append_word(out, 0x004e4942);
    out.insert(out.end(), buffer.bytes.begin(), buffer.bytes.end());
  }
  return out;
}

}  // namespace troffer
