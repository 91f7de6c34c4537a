#include "export/export_scene.h"

#include <filesystem>

#include "base/error.h"
#include "export/gltf_writer.h"
#include "export/pbrt_writer.h"

namespace troffer {

namespace {

std::string ending_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

}  // namespace

void check_scene_format(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending != ".pbrt" && ending != ".gltf" && ending != ".glb")
    throw UsageError("cannot write " + path + ": its name should end in .pbrt, .gltf or .glb");
}

std::vector<Warning> export_scene(const Scene& scene, const std::string& path) {
  check_scene_format(path);
  return ending_of(path) == ".pbrt" ? write_pbrt(scene, path) : write_gltf(scene, path);
}

}  // namespace troffer
