// Saving and loading of solutions (solution.h).
#include <bit>
#include <cstring>

#include "base/error.h"
#include "base/random.h"
#include "radiosity/solution.h"

namespace troffer {

namespace {

constexpr char magic[8] = {'t', 'r', 'o', 'f', 'f', 'R', 'a', 'd'};
constexpr uint32_t version = 2;
static_assert(std::endian::native == std::endian::little, "solutions are little endian");

class Hasher {
 public:
  void add(uint64_t v) { h_ = hash_combine(h_, v); }
  void add(float v) { add(uint64_t(std::bit_cast<uint32_t>(v))); }
  void add(const Vec3& v) {
    for (size_t i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Vec2& v) {
    add(v.x);
    add(v.y);
  }
  void add(Rgb c) {
    for (size_t i = 0; i < 3; ++i) add(c[i]);
  }
  void add(const ColorInput& c) {
    add(c.value);
    add(uint64_t(c.texture));
  }
  void add(const FloatInput& c) {
    add(c.value);
    add(uint64_t(c.texture));
    add(uint64_t(c.channel));
  }
  uint64_t value() const { return h_; }

 private:
  uint64_t h_ = version;
};

void add_geometry(Hasher& h, const Scene& scene) {
  h.add(scene.meshes.size());
  for (const Mesh& m : scene.meshes) {
    h.add(m.positions.size());
    for (const Vec3& p : m.positions) h.add(p);
    h.add(m.uvs.size());
    for (const Vec2& p : m.uvs) h.add(p);
    h.add(m.triangles.size());
    for (const Triangle& t : m.triangles)
      for (const uint32_t v : t) h.add(uint64_t(v));
    h.add(m.emitters.size());
    for (const int32_t e : m.emitters) h.add(uint64_t(e));
    h.add(uint64_t(m.material));
  }
  h.add(scene.spheres.size());
  for (const Sphere& s : scene.spheres) {
    h.add(s.centre);
    h.add(s.radius);
    h.add(uint64_t(s.is_inside_out));
    h.add(uint64_t(s.material));
    h.add(uint64_t(s.emitter));
  }
  h.add(scene.disks.size());
  for (const Disk& d : scene.disks) {
    h.add(d.centre);
    h.add(d.normal);
    h.add(d.radius);
    h.add(uint64_t(d.material));
    h.add(uint64_t(d.emitter));
  }
}

void add_material(Hasher& h, const Material& m) {
  h.add(uint64_t(m.kind));
  h.add(uint64_t(m.roughness_meaning));
  for (const ColorInput& c : {m.base_color, m.specular_color}) h.add(c);
  for (const FloatInput& f : {m.roughness, m.metallic, m.specular, m.transmission, m.alpha})
    h.add(f);
  h.add(m.ior);
  h.add(uint64_t(m.is_thin) | uint64_t(m.is_reflectance) << 1 | uint64_t(m.is_alpha_masked) << 2);
  h.add(m.eta);
  h.add(m.k);
  h.add(m.alpha_cutoff);
}

void add_texture(Hasher& h, const Texture& t) {
  h.add(uint64_t(t.kind));
  h.add(t.value);
  h.add(uint64_t(t.factor_a) << 32 | t.factor_b);
  h.add(uint64_t(t.width) << 32 | uint64_t(t.height));
  h.add(uint64_t(t.channels));
  h.add(t.texels8.size());
  for (const uint8_t v : t.texels8) h.add(uint64_t(v));
  h.add(t.texels_float.size());
  for (const float v : t.texels_float) h.add(v);
  h.add(uint64_t(t.is_srgb) | uint64_t(t.is_inverted) << 1 | uint64_t(t.is_filtered) << 2 |
        uint64_t(t.wrap_u) << 8 | uint64_t(t.wrap_v) << 16);
  h.add(t.uv_scale);
  h.add(t.uv_offset);
  h.add(t.uv_rotation_rad);
}

uint64_t points_key(const RadiosityMesh& mesh) {
  Hasher h;
  for (const ElementPoint& p : mesh.points) {
    h.add(p.position);
    h.add(p.normal);
  }
  return h.value();
}

// ---- bytes ----

struct Header {
  char magic[8];
  uint32_t version;
  uint32_t stored_per_point;
  uint64_t key, points_key;
  uint64_t points;
  uint64_t rays;
  uint32_t shots;
  uint32_t is_complete;
  float ambient[3];
  uint32_t emitters;
  double balance[6];
  uint32_t patches;
  float mean_irradiance;
  uint64_t hash;  // of all else: header with 0 here, and body
};
static_assert(sizeof(Header) == 136);

struct FilePoint {
  float general[3], general_direct[3];
};
struct FilePatch {
  float shot_radiance[3];
};
struct FileContribution {
  uint32_t source;
  float received[3], unoccluded[3];
};

uint64_t hash_bytes(std::span<const uint8_t> bytes) {
  Hasher h;
  h.add(bytes.size());
  size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    uint64_t v = 0;
    std::memcpy(&v, bytes.data() + i, 8);
    h.add(v);
  }
  for (; i < bytes.size(); ++i) h.add(uint64_t(bytes[i]));
  return h.value();
}

void put(float (&to)[3], Rgb c) {
  for (size_t i = 0; i < 3; ++i) to[i] = c[i];
}
Rgb get(const float (&from)[3]) {
  return {from[0], from[1], from[2]};
}

template <class T>
void append(std::vector<uint8_t>& out, const T& v) {
  const size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &v, sizeof(T));
}
template <class T>
T read(std::span<const uint8_t> bytes, size_t at) {
  T v;
  std::memcpy(&v, bytes.data() + at, sizeof(T));
  return v;
}

}  // namespace

namespace {

uint64_t hash_of_file(Header h, std::span<const uint8_t> body) {
  h.hash = 0;
  std::vector<uint8_t> header;
  append(header, h);
  return hash_combine(hash_bytes(header), hash_bytes(body));
}

}  // namespace

uint64_t solution_key(const Scene& scene, const RadiosityOptions& o) {
  Hasher h;
  add_geometry(h, scene);
  h.add(scene.materials.size());
  for (const Material& m : scene.materials) add_material(h, m);
  h.add(scene.textures.size());
  for (const Texture& t : scene.textures) add_texture(h, t);
  h.add(scene.emitters.size());
  for (const Emitter& e : scene.emitters) {
    h.add(uint64_t(e.shape) | uint64_t(e.is_two_sided) << 8);
    h.add(e.radiance);
    h.add(uint64_t(e.texture));
    h.add(uint64_t(e.geometry));
    for (const Vec3& p : e.polygon) h.add(p);
  }
  h.add(o.meshing.element_size);
  h.add(o.meshing.patch_size);
  h.add(o.meshing.join_angle_deg);
  h.add(uint64_t(o.meshing.max_elements) << 32 | o.meshing.max_sheets);
  h.add(uint64_t(o.meshing.prune_hidden_sides));
  h.add(uint64_t(o.stored_per_point) << 32 | o.max_shots);
  h.add(o.unshot_fraction);
  h.add(uint64_t(o.max_rays));
  h.add(o.tolerance);
  h.add(uint64_t(o.emitter_rays));
  h.add(o.emitter_share);
  h.add(o.seed);
  return h.value();
}

std::vector<uint8_t> save_solution(const Scene& scene, const RadiositySolution& s) {
  std::vector<uint8_t> body;
  const size_t points = s.general.size();
  body.reserve(points * (sizeof(FilePoint) + s.stored_per_point * sizeof(FileContribution)) +
               s.shot_radiance.size() * sizeof(FilePatch));
  for (size_t i = 0; i < points; ++i) {
    FilePoint p;
    put(p.general, s.general[i]);
    put(p.general_direct, s.general_direct[i]);
    append(body, p);
  }
  for (const StoredContribution& c : s.stored) {
    FileContribution f;
    f.source = c.source;
    put(f.received, c.received);
    put(f.unoccluded, c.unoccluded);
    append(body, f);
  }
  for (const Rgb& radiance : s.shot_radiance) {
    FilePatch p;
    put(p.shot_radiance, radiance);
    append(body, p);
  }
  Header h{};
  std::memcpy(h.magic, magic, sizeof(magic));
  h.version = version;
  h.stored_per_point = s.stored_per_point;
  h.key = solution_key(scene, s.options);
  h.points_key = points_key(s.mesh);
  h.points = points;
  h.rays = s.rays;
  h.shots = s.shots;
  h.is_complete = s.is_complete;
  put(h.ambient, s.ambient);
  h.emitters = s.emitter_count;
  h.patches = uint32_t(s.shot_radiance.size());
  h.mean_irradiance = s.mean_irradiance;
  const EnergyBalance& b = s.balance;
  const double balance[6] = {b.emitted,          b.shot,   b.absorbed,
                             b.lost_to_specular, b.unshot, b.escaped};
  std::memcpy(h.balance, balance, sizeof(balance));
  h.hash = hash_of_file(h, body);
  std::vector<uint8_t> out;
  out.reserve(sizeof(Header) + body.size());
  append(out, h);
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

namespace {

// All that can be told without the mesh.
Header checked_header(std::span<const uint8_t> bytes, const std::string& file, uint64_t key) {
  const auto refuse = [&](const std::string& what) { throw InputError(file, 0, 0, what); };
  if (bytes.size() < sizeof(magic) || std::memcmp(bytes.data(), magic, sizeof(magic)) != 0)
    refuse("not a radiosity solution");
  if (bytes.size() < sizeof(Header)) refuse("radiosity solution is cut short");
  const auto h = read<Header>(bytes, 0);
  if (h.version != version)
    refuse("radiosity solution of version " + std::to_string(h.version) + "; this program reads " +
           std::to_string(version));
  if (h.stored_per_point > max_stored) refuse("radiosity solution is damaged");
  const size_t per_point = sizeof(FilePoint) + h.stored_per_point * sizeof(FileContribution);
  const size_t body = bytes.size() - sizeof(Header), patches = h.patches * sizeof(FilePatch);
  if (h.points > body / per_point || h.points * per_point + patches > body)
    refuse("radiosity solution is cut short");
  if (h.points * per_point + patches != body) refuse("radiosity solution has bytes too many");
  if (hash_of_file(h, bytes.subspan(sizeof(Header))) != h.hash)
    refuse("radiosity solution is damaged");
  if (h.key != key)
    refuse("radiosity solution belongs to another scene or to other settings: compute it anew");
  return h;
}

}  // namespace

RadiositySolution load_solution(std::span<const uint8_t> bytes, const std::string& file,
                                const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                const RadiosityOptions& options, int threads) {
  const Header h = checked_header(bytes, file, solution_key(scene, options));
  RadiositySolution s;
  s.options = options;
  s.mesh = mesh_for_radiosity(scene, tracer, tables, options.meshing, threads);
  if (h.points != s.mesh.points.size() || h.patches != s.mesh.patches.size() ||
      h.points_key != points_key(s.mesh))
    throw InputError(file, 0, 0, "radiosity solution was computed on another mesh of this scene");
  s.emitter_count = uint32_t(scene.emitters.size());
  s.stored_per_point = h.stored_per_point;
  s.ambient = get(h.ambient);
  s.balance = {h.balance[0], h.balance[1], h.balance[2], h.balance[3], h.balance[4], h.balance[5]};
  s.shots = h.shots;
  s.rays = h.rays;
  s.is_complete = h.is_complete != 0;
  size_t at = sizeof(Header);
  for (size_t i = 0; i < h.points; ++i, at += sizeof(FilePoint)) {
    const auto p = read<FilePoint>(bytes, at);
    s.general.push_back(get(p.general));
    s.general_direct.push_back(get(p.general_direct));
  }
  const size_t sources = s.emitter_count + s.mesh.patches.size();
  for (size_t i = 0; i < h.points * h.stored_per_point; ++i, at += sizeof(FileContribution)) {
    const auto c = read<FileContribution>(bytes, at);
    if (c.source != no_source && c.source >= sources)
      throw InputError(file, 0, 0, "radiosity solution is damaged");
    s.stored.push_back({c.source, get(c.received), get(c.unoccluded)});
  }
  for (size_t i = 0; i < h.patches; ++i, at += sizeof(FilePatch))
    s.shot_radiance.push_back(get(read<FilePatch>(bytes, at).shot_radiance));
  s.mean_irradiance = h.mean_irradiance;
  return s;
}

}  // namespace troffer
