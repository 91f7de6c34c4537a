// Automatic search for desks and floors, and surfaces by name.
#include <doctest/doctest.h>

#include "base/error.h"
#include "report/find_surfaces.h"
#include "room.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr Vec3d up{0, 0, 1};

std::vector<std::string> names(const FoundSurfaces& found) {
  std::vector<std::string> n;
  for (const AssessedSurface& s : found.surfaces) n.push_back(s.name);
  return n;
}

}  // namespace

TEST_CASE("an office: desk and floor are found, but not cabinet, shelf or ceiling") {
  const PreparedScene scene(small_office());
  const FoundSurfaces found = find_surfaces(scene, up, "office-writing", 0.75);
  REQUIRE(names(found) == std::vector<std::string>{"desk", "floor"});
  const AssessedSurface &desk = found.surfaces[0], &floor = found.surfaces[1];
  CHECK(desk.kind == SurfaceKind::desk);
  CHECK(desk.above_floor == doctest::Approx(0.74));
  CHECK(desk.width == doctest::Approx(1.6));
  CHECK(desk.height == doctest::Approx(0.8));
  CHECK(desk.profile == "office-writing");
  CHECK(floor.kind == SurfaceKind::floor);
  CHECK(floor.area == doctest::Approx(20));
  CHECK(floor.border == 0.5);
  CHECK(floor.profile == "background");
}

TEST_CASE(
    "without desks there is a work plane above each floor; two storeys have two floors; roofs do "
    "not count") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_box_inside(s, grey, {0, 0, 0}, {4, 3, 2.6f});
  add_box_inside(s, grey, {0, 0, 3}, {4, 3, 5.6f});
  add_quad(s, grey, {Vec3{0, 0, 6}, {4, 0, 6}, {4, 3, 6}, {0, 3, 6}});  // the roof
  add_quad(s, grey, {Vec3{-20, -20, -0.2f}, {20, -20, -0.2f}, {20, 20, -0.2f}, {-20, 20, -0.2f}});
  const PreparedScene scene(std::move(s));
  const FoundSurfaces found = find_surfaces(scene, up, "meeting", 0.8);
  REQUIRE(found.surfaces.size() == 2);
  CHECK(found.surfaces[0].kind == SurfaceKind::work_plane);
  CHECK(found.surfaces[0].corner.z == doctest::Approx(0.8));
  CHECK(found.surfaces[1].corner.z == doctest::Approx(3.8));
  CHECK(found.surfaces[1].profile == "meeting");
  CHECK(found.floors.size() == 2);
}

TEST_CASE("a place without a ceiling still has its floor") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  const PreparedScene scene(std::move(s));
  CHECK(find_surfaces(scene, up, "none", 0.75).surfaces.size() == 1);
  CHECK(find_surfaces(scene, {0, 1, 0}, "none", 0.75).surfaces.empty());
}

TEST_CASE("surfaces by name: tops of bodies, boards and rectangles; others are refused") {
  const PreparedScene scene(small_office());
  SurfaceRequest cabinet{"cabinet", "archive", "", 0.01, 0.1, {}, {}, {}};
  SurfaceRequest board{"", "board", "board", 0, -1, {0.5, 0, 1}, {0, 0, 1}, {2, 0, 0}};
  const FoundSurfaces found = asked_surfaces(scene, up, {cabinet, board}, "none");
  REQUIRE(found.surfaces.size() == 2);
  CHECK(found.surfaces[0].corner.z == doctest::Approx(1.11));
  CHECK(found.surfaces[0].area == doctest::Approx(1.6));
  CHECK(found.surfaces[0].profile == "archive");
  CHECK(found.surfaces[1].normal().y == doctest::Approx(1));
  CHECK(asked_surfaces(scene, up, {{"shelf", "", "", 0, -1, {}, {}, {}}}, "none").surfaces.size() ==
        2);

  const auto wall =
      asked_surfaces(scene, up, {{"", "", "w", 0, 0, {}, {1, 0, 0}, {0, 1, 0}}}, "none");
  CHECK(wall.surfaces[0].normal().z == 1);
  CHECK_THROWS_AS(asked_surfaces(scene, up, {{"nobody", "", "", 0, 0, {}, {}, {}}}, "none"),
                  UsageError);
  CHECK_THROWS_AS(
      asked_surfaces(scene, up, {{"", "", "x", 0, 0, {}, {1, 0, 0}, {1, 1, 0}}}, "none"),
      UsageError);
}

TEST_CASE("points within bodies are covered, points under a table are not; openings show the sky") {
  const PreparedScene scene(small_office());
  const auto is_covered = covered_points(
      scene, {{3.6, 1, 0}, {1.5, 2, 0}, {1.5, 2, 0.72}, {1.5, 2, 0.75}, {0.5, 4.2, 0.85}}, up);
  CHECK(is_covered == std::vector<uint8_t>{1, 0, 1, 0, 0});
  CHECK_FALSE(sees_beyond(scene, {{2, 3, 0}, {0.5, 0.5, 0.5}}, up));
  Scene open = small_office();
  open.meshes.erase(open.meshes.begin() + 4);  // a wall
  for (Light& e : open.lights) e.geometry -= 1;
  const PreparedScene lit(std::move(open));
  CHECK(sees_beyond(lit, {{2, 3, 0}}, up));
}
