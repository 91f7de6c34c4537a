// Imports every scene and mesh file of ../shared/badinputs in-process. Each must load or throw
// InputError, as its label says, and quickly. No other exception may escape.
#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/error.h"
#include "import/file.h"
#include "import/import.h"
#include "import/mesh/ply.h"
#include "import/mesh_clean.h"
#include "support/stopwatch.h"

using namespace troffer;

namespace test_badinputs {

namespace {

// Files for which we disagree with the label, and why.
const std::map<std::string, std::string> exceptions{
    {"gltf-validator/base/data/image/invalid_image_data.gltf",
     "nothing shows the broken image, and one that is shown would be a warning"},
    {"gltf-validator/base/data/image/png_eos.gltf", "likewise"},
    {"magnum/GltfImporter/mesh-sparse.gltf",
     "its sparse indices do not ascend, as they must (glTF 2.0, 3.6.2.3)"},
    {"magnum/GltfImporter/version-legacy.gltf",
     "glTF 1.0 is another format (and an error in asset/1_0_version.gltf)"},
    {"assimp/glTF2/MorphStressTest/glTF/MorphStressTest.gltf",
     "its geometry is in a .bin that the collection does not have"},
};

enum class Outcome { loads, error, other };

Scene import_any(const std::string& path, const std::string& format) {
  if (format != "ply") return import_scene(path);
  Scene scene;
  scene.meshes.push_back(read_ply(path, scene.warnings).mesh);
  clean_mesh(scene.meshes[0], scene.warnings);
  scene.materials.emplace_back();
  return scene;
}

Outcome outcome_of(const std::string& path, const std::string& format, std::string& what) {
  try {
    const Scene scene = import_any(path, format);
    for (const Mesh& mesh : scene.meshes) {
      CHECK(mesh.material < scene.materials.size());
      for (const Triangle& t : mesh.triangles)
        for (const uint32_t v : t) REQUIRE(v < mesh.positions.size());
      for (const Vec3& p : mesh.positions) REQUIRE(is_finite(p));
      for (const Vec3& n : mesh.normals) REQUIRE(length(n) == doctest::Approx(1));
    }
    return Outcome::loads;
  } catch (const InputError& e) {
    what = e.what();
    return Outcome::error;
  } catch (const std::exception& e) {
    what = e.what();
    return Outcome::other;
  }
}

// Imports every file of these formats and returns their number; 0 if the collection is missing.
size_t check_all(const std::set<std::string>& formats) {
  const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/../shared/badinputs";
  if (!std::filesystem::exists(folder + "/manifest.json")) {
    MESSAGE("skipped: ../shared/badinputs is not here");
    return 0;
  }
  const auto manifest = nlohmann::json::parse(read_text_file(folder + "/manifest.json"));
  size_t count = 0;
  for (const auto& entry : manifest) {
    const std::string format = entry["format"];
    if (formats.count(format) == 0) continue;
    ++count;
    const std::string file = entry["file"], expected = entry["expected"];
    std::string what;
    const test::ProcessorStopwatch watch;
    const Outcome outcome = outcome_of(folder + "/" + file, format, what);
    const double seconds = watch.seconds();
    CAPTURE(file);
    CAPTURE(what);
    CHECK(seconds < 10);
    CHECK(outcome != Outcome::other);
    CHECK(what.find('\n') == std::string::npos);
    if (exceptions.count(file) > 0) continue;
    if (expected == "error") CHECK(outcome == Outcome::error);
    if (expected == "loads") CHECK(outcome == Outcome::loads);
  }
  return count;
}

}  // namespace

TEST_CASE("glTF files of other projects load or fail as expected") {
  const size_t count = check_all({"gltf", "glb"});
  CHECK((count == 0 || count > 100));
}

TEST_CASE("OBJ, PLY and pbrt files of other projects load or fail as expected") {
  const size_t count = check_all({"obj", "ply", "pbrt"});
  CHECK((count == 0 || count > 50));
}

}  // namespace test_badinputs
