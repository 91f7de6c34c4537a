// Every OBJ, PLY and pbrt file of ../shared/badinputs is imported in-process: it loads or throws
// InputError, as its label says, quickly, and nothing else ever escapes.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "import/file.h"
#include "import/mesh_clean.h"
#include "import/obj.h"
#include "import/pbrt.h"
#include "import/ply.h"

using namespace troffer;

namespace {

// Where we disagree with the label, and why.
const std::map<std::string, std::string> exceptions{};

enum class Outcome { loads, error, other };

Scene import_any(const std::string& path, const std::string& format) {
  if (format == "obj") return import_obj(path);
  if (format == "pbrt") return import_pbrt(path);
  Scene scene;
  scene.meshes.push_back(read_ply(path, scene.warnings));
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

}  // namespace

TEST_CASE("OBJ, PLY and pbrt files that others wrote load or fail as they should") {
  const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/../shared/badinputs";
  if (!std::filesystem::exists(folder + "/manifest.json")) {
    MESSAGE("skipped: ../shared/badinputs is not here");
    return;
  }
  const auto manifest = nlohmann::json::parse(read_text_file(folder + "/manifest.json"));
  size_t count = 0;
  for (const auto& entry : manifest) {
    const std::string format = entry["format"];
    if (format != "obj" && format != "ply" && format != "pbrt") continue;
    ++count;
    const std::string file = entry["file"], expected = entry["expected"];
    std::string what;
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = outcome_of(folder + "/" + file, format, what);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CAPTURE(file);
    CAPTURE(what);
    CHECK(seconds.count() < 10);
    CHECK(outcome != Outcome::other);
    CHECK(what.find('\n') == std::string::npos);
    if (exceptions.count(file) > 0) continue;
    if (expected == "error") CHECK(outcome == Outcome::error);
    if (expected == "loads") CHECK(outcome == Outcome::loads);
  }
  CHECK(count > 50);
}
