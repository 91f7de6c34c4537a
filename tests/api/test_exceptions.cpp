// Additions to a scene that fail midway leave it as it was. Memory runs out at every allocation of
// the calling thread in turn.
#include <doctest/doctest.h>

#include <cstdlib>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "troffer/troffer.h"

namespace {

thread_local long allocations_left = -1;  // negative: no limit

void* allocated(std::size_t size) {
  if (allocations_left == 0) throw std::bad_alloc();
  if (allocations_left > 0) --allocations_left;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return allocated(size);
}
void* operator new[](std::size_t size) {
  return allocated(size);
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete[](void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}

using namespace troffer;

namespace {

struct Contents {
  std::size_t triangles;
  std::vector<std::string> materials, lights, warnings, cameras;
  bool operator==(const Contents&) const = default;
};

Contents contents(const api::Scene& s) {
  return {s.triangle_count(), s.material_names(), s.light_names(), s.warnings(), s.camera_names()};
}

// Lets the n-th allocation of `add` fail, for n = 1, 2 … until there are fewer. Returns how often
// it failed.
int check_all_or_nothing(api::Scene& scene, const std::function<void(api::Scene&)>& add) {
  const Contents before = contents(scene);
  for (long n = 0;; ++n) {
    bool has_failed = false;
    allocations_left = n;
    try {
      add(scene);
    } catch (const std::bad_alloc&) {
      has_failed = true;
    }
    allocations_left = -1;
    if (!has_failed) return int(n);
    CAPTURE(n);
    REQUIRE(contents(scene) == before);
  }
}

api::MeshData lamp() {
  api::MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 0, 1}};  // one without area: a warning
  mesh.emission =
      api::Emission{{1, 1, 1}, false, {}, "a lamp whose name is long enough to allocate"};
  return mesh;
}

}  // namespace

TEST_CASE("an addition that fails for want of memory leaves the scene as it was") {
  api::Scene scene;
  CHECK(check_all_or_nothing(scene, [](api::Scene& s) { s.add_mesh(lamp()); }) > 10);
  CHECK(scene.light_names().size() == 1);
  CHECK(scene.material_names().size() == 1);
  CHECK(check_all_or_nothing(scene, [](api::Scene& s) {
          api::SphereData ball;
          ball.name = "a ball whose name is long enough to allocate";
          ball.centre = {2, 2, 2};
          ball.emission = api::Emission{{1, 1, 1}, false, {}, ""};
          s.add_sphere(ball);
        }) > 3);
  CHECK(scene.light_names().size() == 2);
  CHECK(check_all_or_nothing(scene, [](api::Scene& s) {
          api::Luminaire light;
          light.name = "downlight with a long name in the middle of the room";
          light.file = std::string(TROFFER_SOURCE_DIR) + "/scenes/office/louvred.ies";
          light.position = {0.5, 0.5, 2};
          s.add_light(light);
        }) > 10);
  CHECK(scene.light_names().size() == 3);
  CHECK(check_all_or_nothing(scene, [](api::Scene& s) {
          api::Sky sky;
          sky.kind = "overcast";
          s.add_light(sky);
        }) > 1);
  CHECK(check_all_or_nothing(scene, [](api::Scene& s) {
          s.add_camera("view", {{0, 0, 1}, {1, 1, 1}});
        }) > 0);
}
