#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/luminaire_info.h"
#include "app/output_guard.h"
#include "app/printable.h"
#include "app/process.h"
#include "app/up_json.h"
#include "base/box.h"
#include "base/error.h"
#include "import/import.h"
#include "render/source_info.h"

namespace troffer {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
size_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

size_t geometry_bytes(const Scene& scene) {
  size_t bytes = bytes_of(scene.spheres) + bytes_of(scene.disks) + bytes_of(scene.instances);
  for (const std::vector<Mesh>* const meshes : {&scene.meshes, &scene.instanced_meshes})
    for (const Mesh& m : *meshes)
      bytes += bytes_of(m.positions) + bytes_of(m.normals) + bytes_of(m.uvs) + bytes_of(m.uvs_2) +
               bytes_of(m.triangles) + bytes_of(m.lights);
  return bytes;
}

size_t texture_bytes(const Scene& scene) {
  size_t bytes = 0;
  for (const Texture& t : scene.textures) bytes += bytes_of(t.texels8) + bytes_of(t.texels_float);
  return bytes;
}

Json info_json(const Scene& scene, const UpDecision& up) {
  size_t light_triangles = 0;
  for (const Mesh& m : scene.meshes)
    for (const int32_t e : m.lights) light_triangles += e >= 0;

  const std::vector<SourceInfo> infos = source_infos(scene);

  Json j;
  j["triangles"] = triangle_count(scene);
  j["meshes"] = scene.meshes.size() + scene.instances.size();
  j["instances"] = scene.instances.size();
  j["instanced_meshes"] = scene.instanced_meshes.size();
  j["stored_triangles"] = stored_triangle_count(scene);
  j["materials"] = scene.materials.size();
  j["textures"] = scene.textures.size();
  j["emitters"] = scene.lights.size();
  j["emitter_triangles"] = light_triangles;
  j["lights"] = Json::array();
  for (const Light& e : scene.lights) j["lights"].push_back(e.name);
  j["cameras"] = Json::array();
  for (const Camera& c : scene.cameras) j["cameras"].push_back(c.name);
  j["grids"] = Json::array();
  for (const SensorGrid& g : scene.grids)
    j["grids"].push_back({{"name", g.name}, {"room", g.room}, {"points", g.positions.size()}});
  j["dynamic_groups"] = Json::array();
  for (const DynamicGroup& g : scene.dynamic_groups)
    j["dynamic_groups"].push_back({{"name", g.name}, {"states", g.states}, {"shown", g.shown}});
  const Boxd box = bounds_in_file(scene);
  if (box.is_empty())
    j["bounds"] = nullptr;
  else
    j["bounds"] = {{box.lower.x, box.lower.y, box.lower.z},
                   {box.upper.x, box.upper.y, box.upper.z}};
  j["up"] = up_json(up);
  j["warnings"] = Json::array();
  for (const Warning& w : scene.warnings.entries())
    j["warnings"].push_back({{"text", w.text}, {"count", w.count}});
  j["spheres"] = scene.spheres.size();
  j["disks"] = scene.disks.size();
  j["is_photometric"] = scene.is_photometric;
  constexpr double mib = 1 << 20;
  j["memory_mb"] = {{"geometry", double(geometry_bytes(scene)) / mib},
                    {"textures", double(texture_bytes(scene)) / mib},
                    {"peak", peak_memory_mb()}};
  j["sources"] = Json::array();
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& e = scene.lights[i];
    j["sources"].push_back({{"name", e.name},
                            {"shape", name_of(e.kind)},
                            {"area", infos[i].area},
                            {"radiance", {e.radiance.r, e.radiance.g, e.radiance.b}},
                            {"power", infos[i].power},
                            {"is_two_sided", e.is_two_sided}});
  }
  return j;
}

void print_text(const Scene& scene, const Json& j, const UpDecision& up) {
  fmt::print("scene      {}\n", printable(scene.file));
  for (const char* key : {"triangles", "meshes", "materials", "textures", "spheres", "disks"})
    fmt::print("{:<10} {}\n", key, j[key].get<size_t>());
  if (!scene.instances.empty())
    fmt::print("instances  {} of {} meshes; {} triangles stored\n", scene.instances.size(),
               scene.instanced_meshes.size(), stored_triangle_count(scene));
  const Json& memory = j["memory_mb"];
  fmt::print("memory     {:.1f} MB of geometry, {:.1f} MB of textures; {:.1f} MB to read them\n",
             memory["geometry"].get<double>(), memory["textures"].get<double>(),
             memory["peak"].get<double>());
  const Boxd box = bounds_in_file(scene);
  // A scene far from its file's origin needs more digits to show millimetres.
  const int digits = scene.origin == Vec3d{} ? 6 : 9;
  if (!box.is_empty())
    fmt::print("bounds     {:.{}g} {:.{}g} {:.{}g}  to  {:.{}g} {:.{}g} {:.{}g}\n", box.lower.x,
               digits, box.lower.y, digits, box.lower.z, digits, box.upper.x, digits, box.upper.y,
               digits, box.upper.z, digits);
  fmt::print("up         {}, {}\n", name_of_up(up.up), up.reason);
  fmt::print("cameras    {}\n", scene.cameras.size());
  for (const Camera& c : scene.cameras) {
    fmt::print("  {}", printable(c.name));
    if (c.width > 0) fmt::print("  {}x{}", c.width, c.height);
    fmt::print("\n");
  }
  for (const SensorGrid& g : scene.grids)
    fmt::print("grid       {}: {} points\n", printable(g.name), g.positions.size());
  for (const DynamicGroup& g : scene.dynamic_groups) {
    fmt::print("group      {}: shows state {} of {}\n", printable(g.name), g.shown,
               g.states.size());
    for (const std::string& state : g.states) fmt::print("  {}\n", printable(state));
  }
  fmt::print("emitters   {} of {} triangles\n", scene.lights.size(),
             j["emitter_triangles"].get<size_t>());
  for (const Json& s : j["sources"])
    fmt::print("  {:<16} {:<8} {:10.4g} m2  {:10.4g} {}{}\n",
               printable(s["name"].get<std::string>()), s["shape"].get<std::string>(),
               s["area"].get<double>(), s["power"].get<double>(), scene.is_photometric ? "lm" : "W",
               s["is_two_sided"].get<bool>() ? "  two-sided" : "");
  if (scene.warnings.total() > 0) fmt::print("warnings   {}\n", scene.warnings.total());
  for (const Warning& w : scene.warnings.entries()) {
    fmt::print("  {}", printable(w.text));
    if (w.count > 1) fmt::print(" ({} times)", w.count);
    fmt::print("\n");
  }
}

}  // namespace

int run_info(const InfoCommand& command) {
  if (is_luminaire(command.scene.file)) {
    OutputGuard guard;
    guard.add_input("the luminaire", command.scene.file);
    guard.add_output("--polar", command.polar);
    fmt::print("{}", luminaire_info(command.scene.file, command.is_json, command.polar));
    return exit_done;
  }
  if (!command.polar.empty()) throw UsageError("--polar goes with an .ies or .ldt file");
  Scene scene = import_scene(command.scene.file, command.scene.options);
  if (scene.lights.empty()) scene.warnings.add("the scene has no light");
  const UpDecision up = up_of(command.scene, scene);
  if (!up.doubt.empty()) scene.warnings.add(up.doubt);
  const Json j = info_json(scene, up);
  if (command.is_json)
    // Names in files may contain any bytes; invalid UTF-8 is replaced.
    fmt::print("{}\n", j.dump(2, ' ', false, Json::error_handler_t::replace));
  else
    print_text(scene, j, up);
  return exit_done;
}

}  // namespace troffer
