// Saves and loads solutions (solution.h).
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "base/hasher.h"
#include "base/own_file.h"
#include "radiosity/solution.h"

namespace troffer {

namespace {

constexpr OwnFile solution_file{{'t', 'r', 'o', 'f', 'f', 'R', 'a', 'd'}, 3, "radiosity solution"};

uint64_t points_key(const RadiosityMesh& mesh) {
  Hasher h(2);
  for (const ElementPoint& p : mesh.points) {
    h.add(p.position);
    h.add(p.normal);
  }
  return h.value();
}

// ---- bytes ----

struct FileOptions {
  float element_size, patch_size, join_angle_deg;
  uint32_t max_elements, max_sheets, prune_hidden_sides;
  uint32_t stored_per_point;
  float unshot_fraction;
  uint32_t max_shots;
  int32_t max_rays;
  float tolerance;
  int32_t light_rays;
  float light_share;
  uint32_t seed[2];
  uint32_t max_million_rays;
};
static_assert(sizeof(FileOptions) == 64);

struct Header {
  char magic[8];
  uint32_t version;
  uint32_t stored_per_point;
  uint64_t scene_key, points_key;
  FileOptions options;
  uint64_t points;
  uint64_t rays;
  uint32_t shots;
  uint32_t end;
  float ambient[3];
  uint32_t lights;
  double balance[7];
  uint32_t patches;
  float mean_irradiance;
  uint64_t hash;  // hash of everything else: header with 0 here, and body
};
static_assert(sizeof(Header) == 208);

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

void put(float (&to)[3], Rgb c) {
  for (size_t i = 0; i < 3; ++i) to[i] = c[i];
}
Rgb get(const float (&from)[3]) {
  return {from[0], from[1], from[2]};
}

FileOptions packed(const RadiosityOptions& o) {
  FileOptions f{};
  f.element_size = o.meshing.element_size;
  f.patch_size = o.meshing.patch_size;
  f.join_angle_deg = o.meshing.join_angle_deg;
  f.max_elements = o.meshing.max_elements;
  f.max_sheets = o.meshing.max_sheets;
  f.prune_hidden_sides = o.meshing.prune_hidden_sides ? 1 : 0;
  f.stored_per_point = o.stored_per_point;
  f.unshot_fraction = o.unshot_fraction;
  f.max_shots = o.max_shots;
  f.max_rays = o.max_rays;
  f.tolerance = o.tolerance;
  f.light_rays = o.light_rays;
  f.light_share = o.light_share;
  f.seed[0] = uint32_t(o.seed);
  f.seed[1] = uint32_t(o.seed >> 32);
  f.max_million_rays = o.max_million_rays;
  return f;
}

RadiosityOptions unpacked(const FileOptions& f) {
  RadiosityOptions o;
  o.meshing.element_size = f.element_size;
  o.meshing.patch_size = f.patch_size;
  o.meshing.join_angle_deg = f.join_angle_deg;
  o.meshing.max_elements = f.max_elements;
  o.meshing.max_sheets = f.max_sheets;
  o.meshing.prune_hidden_sides = f.prune_hidden_sides != 0;
  o.stored_per_point = f.stored_per_point;
  o.unshot_fraction = f.unshot_fraction;
  o.max_shots = f.max_shots;
  o.max_rays = f.max_rays;
  o.tolerance = f.tolerance;
  o.light_rays = f.light_rays;
  o.light_share = f.light_share;
  o.max_million_rays = f.max_million_rays;
  o.seed = f.seed[0] | uint64_t(f.seed[1]) << 32;
  return o;
}

bool is_amount(float x) {
  return x >= 0 && std::isfinite(x);
}

// True if a mesh can be made with these options in bounded time and memory, and the other values
// are valid. The file may come from anyone.
bool is_sane(const FileOptions& f) {
  constexpr uint32_t most = 1u << 22;
  const auto is_size = [](float x) { return x >= 0 && x < 1e30f; };
  return is_size(f.element_size) && is_size(f.patch_size) && f.join_angle_deg >= 0 &&
         f.join_angle_deg <= 180 && f.max_elements <= most && f.max_sheets <= most &&
         f.prune_hidden_sides <= 1 && f.stored_per_point <= max_stored &&
         is_amount(f.unshot_fraction) && is_amount(f.tolerance) && is_amount(f.light_share);
}

// True if the solver can have written these values.
bool is_sane(const Header& h) {
  for (const double power : h.balance)
    if (!std::isfinite(power)) return false;
  return is_sane(h.options) && h.stored_per_point == h.options.stored_per_point &&
         h.end <= uint32_t(RadiosityEnd::out_of_rays) && is_finite(get(h.ambient)) &&
         is_amount(h.mean_irradiance);
}

// Names the first option that differs.
std::string difference(const FileOptions& file, const FileOptions& wanted) {
  const auto tell = [](const char* name, auto a, auto b) {
    return fmt::format("its {} is {}, not {}", name, a, b);
  };
  if (file.element_size != wanted.element_size)
    return tell("element size", file.element_size, wanted.element_size);
  if (file.patch_size != wanted.patch_size)
    return tell("patch size", file.patch_size, wanted.patch_size);
  if (file.stored_per_point != wanted.stored_per_point)
    return tell("number of stored contributions", file.stored_per_point, wanted.stored_per_point);
  if (file.unshot_fraction != wanted.unshot_fraction)
    return tell("unshot fraction", file.unshot_fraction, wanted.unshot_fraction);
  if (file.seed[0] != wanted.seed[0] || file.seed[1] != wanted.seed[1])
    return tell("seed", file.seed[0] | uint64_t(file.seed[1]) << 32,
                wanted.seed[0] | uint64_t(wanted.seed[1]) << 32);
  return "settings of meshing or rays differ";
}

}  // namespace

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
  h.stored_per_point = s.stored_per_point;
  h.scene_key = radiosity_scene_key(scene);
  h.options = packed(s.options);
  h.points_key = points_key(s.mesh);
  h.points = points;
  h.rays = s.rays;
  h.shots = s.shots;
  h.end = uint32_t(s.end);
  put(h.ambient, s.ambient);
  h.lights = s.light_count;
  h.patches = uint32_t(s.shot_radiance.size());
  h.mean_irradiance = s.mean_irradiance;
  const EnergyBalance& b = s.balance;
  const double balance[7] = {b.emitted, b.shot,    b.absorbed,   b.lost_to_specular,
                             b.unshot,  b.escaped, b.unaccounted};
  std::memcpy(h.balance, balance, sizeof(balance));
  return own_file(solution_file, h, body);
}

namespace {

// Reads the header and checks everything that can be checked without the mesh.
Header header_of(std::span<const uint8_t> bytes, const std::string& file) {
  const auto refuse = [&](const std::string& what) { throw InputError(file, 0, 0, what); };
  const auto count = [&](const Header& h, BodySize& body) {
    if (h.stored_per_point > max_stored) refuse("radiosity solution is damaged");
    body.take(h.points, sizeof(FilePoint) + h.stored_per_point * sizeof(FileContribution));
    body.take(h.patches, sizeof(FilePatch));
  };
  const auto h = checked_header<Header>(solution_file, bytes, file, count);
  if (!is_sane(h)) refuse("radiosity solution has invalid values");
  return h;
}

}  // namespace

bool is_radiosity_solution(std::span<const uint8_t> bytes) {
  return solution_file.is_of(bytes);
}

RadiositySolution load_solution(std::span<const uint8_t> bytes, const std::string& file,
                                const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                const RadiosityOptions* options, int threads) {
  const Header h = header_of(bytes, file);
  if (h.end == uint32_t(RadiosityEnd::stopped))
    throw InputError(
        file, 0, 0,
        fmt::format(
            "radiosity solution was interrupted after {} shots: run troffer radiosity to the end",
            h.shots));
  if (h.scene_key != radiosity_scene_key(scene))
    throw InputError(file, 0, 0, "radiosity solution belongs to another scene: compute it again");
  if (options != nullptr) {
    const FileOptions wanted = packed(*options);
    if (std::memcmp(&wanted, &h.options, sizeof(wanted)) != 0)
      throw InputError(
          file, 0, 0,
          "radiosity solution was computed with other settings: " + difference(h.options, wanted));
  }
  RadiositySolution s;
  s.options = unpacked(h.options);
  if (h.lights != scene.lights.size())
    throw InputError(file, 0, 0, "radiosity solution was computed with other light sources");
  s.mesh = mesh_for_radiosity(scene, tracer, tables, s.options.meshing, threads);
  if (h.points != s.mesh.points.size() || h.patches != s.mesh.patches.size() ||
      h.points_key != points_key(s.mesh))
    throw InputError(file, 0, 0, "radiosity solution was computed on another mesh of this scene");
  s.light_count = uint32_t(scene.lights.size());
  s.stored_per_point = h.stored_per_point;
  s.ambient = get(h.ambient);
  s.balance = {h.balance[0], h.balance[1], h.balance[2], h.balance[3],
               h.balance[4], h.balance[5], h.balance[6]};
  s.shots = h.shots;
  s.rays = h.rays;
  s.end = RadiosityEnd(h.end);
  s.is_complete = s.end == RadiosityEnd::converged;
  const auto finite = [&](const float(&from)[3]) {
    const Rgb c = get(from);
    if (!is_finite(c))
      throw InputError(file, 0, 0, "radiosity solution has light that is not finite");
    return c;
  };
  ByteReader body(bytes.subspan(sizeof(Header)));
  for (size_t i = 0; i < h.points; ++i) {
    const auto p = body.next<FilePoint>();
    s.general.push_back(finite(p.general));
    s.general_direct.push_back(finite(p.general_direct));
  }
  const size_t sources = s.light_count + s.mesh.patches.size();
  for (size_t i = 0; i < h.points * h.stored_per_point; ++i) {
    const auto c = body.next<FileContribution>();
    if (c.source != no_source && c.source >= sources)
      throw InputError(file, 0, 0, "radiosity solution is damaged");
    s.stored.push_back({c.source, finite(c.received), finite(c.unoccluded)});
  }
  for (size_t i = 0; i < h.patches; ++i)
    s.shot_radiance.push_back(finite(body.next<FilePatch>().shot_radiance));
  s.mean_irradiance = h.mean_irradiance;
  return s;
}

}  // namespace troffer
