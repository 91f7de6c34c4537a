// Floors within walls: their areas are known, whatever stands on the slab or above it.
#include <doctest/doctest.h>

#include <cmath>

#include "report/find_floors.h"
#include "report/find_surfaces.h"
#include "report/plan_view.h"
#include "room.h"

using namespace troffer;
using namespace troffer::test;

namespace test_find_floors {

namespace {

constexpr Vec3d up{0, 0, 1};

// A room of 6 × 8 × 2.8 m within walls of 20 cm, all of them bodies, on a slab of 6.4 × 8.4 m.
struct House {
  Scene scene;
  uint32_t grey;
  House() : grey(add_diffuse(scene, Rgb{0.5f})) {}
  House& body(const Vec3& a, const Vec3& b, const char* name = "body") {
    add_body(scene, grey, a, b, name);
    return *this;
  }
  House& slab() { return body({-0.2f, -0.2f, -0.3f}, {6.2f, 8.2f, 0}, "slab"); }
  House& roof() { return body({-0.2f, -0.2f, 2.8f}, {6.2f, 8.2f, 3.1f}, "roof"); }
  House& walls() {
    return body({-0.2f, -0.2f, 0}, {6.2f, 0, 2.8f})
        .body({-0.2f, 8, 0}, {6.2f, 8.2f, 2.8f})
        .body({-0.2f, 0, 0}, {0, 8, 2.8f})
        .body({6, 0, 0}, {6.2f, 8, 2.8f});
  }
  House& board(float x0, float y0, float x1, float y1, float z = 0) {
    add_quad(scene, grey, {Vec3{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
    return *this;
  }
  std::vector<double> areas() const {
    std::vector<double> a;
    for (const AssessedSurface& f : find_floors(PreparedScene(Scene(scene)), up))
      a.push_back(std::round(f.area * 1e3) / 1e3);
    return a;
  }
};

House house() {
  House h;
  h.slab().roof().walls();
  return h;
}

using Areas = std::vector<double>;

}  // namespace

TEST_CASE("a slab under walls does not count as floor: 48 m² of 53.8") {
  CHECK(house().areas() == Areas{48});
  House thin;  // walls without thickness, on a slab that extends 30 cm beyond them
  thin.body({-0.3f, -0.3f, -0.3f}, {6.3f, 8.3f, 0}).body({-0.3f, -0.3f, 2.8f}, {6.3f, 8.3f, 3.1f});
  for (const uint32_t m : add_box_inside(thin.scene, thin.grey, {0, 0, 0}, {6, 8, 2.8f}))
    thin.scene.meshes[m].name = "wall";
  CHECK(thin.areas() == Areas{48});
  // Without a roof, only the walls separate the room from the ground around it.
  House open;
  open.slab().walls().board(-20, -20, 20, 20, -0.3f);
  CHECK(open.areas() == Areas{48});
}

TEST_CASE("walls without top and bottom, and walls that miss each other by a millimetre") {
  House hollow;
  hollow.slab().roof();
  for (const auto& [a, b] : {std::pair{Vec3{-0.2f, -0.2f, 0}, Vec3{6.2f, 0, 2.8f}},
                             std::pair{Vec3{-0.2f, 8, 0}, Vec3{6.2f, 8.2f, 2.8f}},
                             std::pair{Vec3{-0.2f, 0, 0}, Vec3{0, 8, 2.8f}},
                             std::pair{Vec3{6, 0, 0}, Vec3{6.2f, 8, 2.8f}}}) {
    hollow.body(a, b);
    std::erase_if(hollow.scene.meshes.back().triangles, [&](const Triangle& t) {
      const auto& p = hollow.scene.meshes.back().positions;
      return p[t[0]].z == p[t[1]].z && p[t[1]].z == p[t[2]].z;
    });
  }
  CHECK(hollow.areas() == Areas{48});

  House gaps;
  const float g = 1e-3f;
  gaps.body({-1, -1, -0.3f}, {7, 9, 0}).body({-1, -1, 2.8f}, {7, 9, 3.1f});
  const auto wall = [&](float x0, float y0, float x1, float y1) {
    add_quad(gaps.scene, gaps.grey, {Vec3{x0, y0, g}, {x1, y1, g}, {x1, y1, 2.8f}, {x0, y0, 2.8f}});
  };
  wall(g, 0, 6 - g, 0);
  wall(6, g, 6, 8 - g);
  wall(6 - g, 8, g, 8);
  wall(0, 8 - g, 0, g);
  REQUIRE(!gaps.areas().empty());
  CHECK(std::abs(gaps.areas()[0] - 48) < 0.002);
}

TEST_CASE("several rooms on one slab, separated by walls above their doors") {
  House h = house();
  h.body({0, 3, 0}, {2, 3.1f, 2.8f}).body({2.9f, 3, 0}, {6, 3.1f, 2.8f});
  h.body({2, 3, 2.1f}, {2.9f, 3.1f, 2.8f});
  CHECK(h.areas() == Areas{29.4, 18});
  const auto floors = find_floors(PreparedScene(Scene(h.scene)), up);
  REQUIRE(floors.size() == 2);
  CHECK(floors[0].name == "slab 1");  // the far one comes first on the plan
  CHECK(floors[1].name == "slab 2");
  CHECK(floors[1].border == doctest::Approx(0.45));  // 15 % of 3 m
}

TEST_CASE("an L-shaped floor: its area, border, points and observers lie on it only") {
  House h = house();
  h.body({3, 4, 0}, {6.2f, 8.2f, 2.8f});
  CHECK(h.areas() == Areas{36});
  const PreparedScene scene(std::move(h.scene));
  const FoundSurfaces found = find_surfaces(scene, up, "none", 0);
  REQUIRE(found.surfaces.size() == 1);
  double rim = 0;
  for (const auto& e : found.surfaces[0].rim) rim += std::sqrt(dot(e[1] - e[0], e[1] - e[0]));
  CHECK(rim == doctest::Approx(28).epsilon(1e-3));
  for (const GridPoint& p : grid_of(found.surfaces[0]).points) {
    CHECK(std::min(p.position.x, p.position.y) > 0.5);
    CHECK((p.position.x < 2.5 || p.position.y < 3.5));
  }
}

TEST_CASE("furniture counts as floor; columns and free-standing walls do not") {
  CHECK(house().body({1, 4, 0}, {5, 4.05f, 1.4f}).areas() == Areas{48});       // a screen
  CHECK(house().body({3, 0.01f, 0}, {5, 0.6f, 2.36f}).areas() == Areas{48});   // a wardrobe
  CHECK(house().body({1, 1, 0}, {3, 3, 0.5f}).areas() == Areas{48});           // a bed
  CHECK(house().body({1, 3, 2.2f}, {5, 3.3f, 2.4f}).areas() == Areas{48});     // a luminaire
  CHECK(house().body({0, 3.8f, 2.4f}, {6, 4.2f, 2.8f}).areas() == Areas{48});  // a beam
  CHECK(house().body({1, 2, 0}, {4, 6, 0.012f}).areas() == Areas{48});         // a rug
  CHECK(house().body({3, 4, 0}, {3.4f, 4.4f, 2.8f}).areas() == Areas{47.84});  // a column
  CHECK(house().body({1, 4, 0}, {5, 4.1f, 2.8f}).areas() == Areas{47.6});      // a wall
  CHECK(house().body({0, 6, 0}, {6, 8, 0.2f}).areas() == Areas{36, 12});       // a podium
}

TEST_CASE("a parapet under a window's glass does not count as floor") {
  House h;
  h.slab().roof();
  h.body({-0.2f, -0.2f, 0}, {6.2f, 0, 2.8f}).body({-0.2f, 0, 0}, {0, 8, 2.8f});
  h.body({6, 0, 0}, {6.2f, 8, 2.8f}).body({-0.2f, 8, 0}, {6.2f, 8.2f, 0.9f});
  h.body({-0.2f, 8, 0.9f}, {0.5f, 8.2f, 2.8f}).body({5.5f, 8, 0.9f}, {6.2f, 8.2f, 2.8f});
  add_quad(h.scene, h.grey,
           {Vec3{0.5f, 8.1f, 0.9f}, {5.5f, 8.1f, 0.9f}, {5.5f, 8.1f, 2.8f}, {0.5f, 8.1f, 2.8f}});
  CHECK(h.areas() == Areas{48});
}

TEST_CASE("a floor of several pieces counts once: boards, overlaps, duplicates") {
  House boards;
  boards.roof().walls();
  for (int i = 0; i < 24; ++i) {  // joints that do not share corners
    const float x = 0.25f * float(i), cut = 2 + 0.37f * float(i % 5);
    boards.board(x, 0, x + 0.25f, cut).board(x, cut, x + 0.25f, 8);
  }
  CHECK(boards.areas() == Areas{48});
  House pieces;
  pieces.roof().walls().board(-0.2f, -0.2f, 4, 8.2f).board(3, -0.2f, 6.2f, 8.2f);
  CHECK(pieces.areas() == Areas{48});
  House twice;
  twice.roof().walls().board(-0.2f, -0.2f, 6.2f, 8.2f).board(-0.2f, -0.2f, 6.2f, 8.2f);
  CHECK(twice.areas() == Areas{48});
}

TEST_CASE("sloping and rotated floors") {
  House ramp;
  ramp.body({-0.2f, -0.2f, 4}, {6.2f, 8.2f, 4.3f})
      .body({-0.2f, -0.2f, -0.5f}, {6.2f, 0, 4})
      .body({-0.2f, 8, -0.5f}, {6.2f, 8.2f, 4})
      .body({-0.2f, 0, -0.5f}, {0, 8, 4})
      .body({6, 0, -0.5f}, {6.2f, 8, 4});
  add_quad(ramp.scene, ramp.grey,
           {Vec3{-0.2f, -0.2f, -0.02f},
            {6.2f, -0.2f, -0.02f},
            {6.2f, 8.2f, 0.82f},
            {-0.2f, 8.2f, 0.82f}});
  REQUIRE(ramp.areas().size() == 1);
  CHECK(ramp.areas()[0] == doctest::Approx(6 * std::hypot(8, 0.8)).epsilon(1e-4));

  House turned = house();
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  for (Mesh& m : turned.scene.meshes)
    for (Vec3& p : m.positions) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  REQUIRE(turned.areas().size() == 1);
  CHECK(turned.areas()[0] == doctest::Approx(48).epsilon(1e-4));
  const auto floors = find_floors(PreparedScene(Scene(turned.scene)), up);
  CHECK(floors[0].width * floors[0].height == doctest::Approx(48).epsilon(1e-3));
}

TEST_CASE("a slab that is named is assessed inside its walls") {
  const PreparedScene scene(house().scene);
  const FoundSurfaces found =
      asked_surfaces(scene, up, {{"slab", "", "", 0.75, 0.5, {}, {}, {}}}, "none");
  REQUIRE(found.surfaces.size() == 1);
  CHECK(found.surfaces[0].area == doctest::Approx(48).epsilon(1e-4));
  CHECK(found.surfaces[0].corner.z == doctest::Approx(0.75));
  CHECK(found.surfaces[0].width == doctest::Approx(6).epsilon(1e-4));
}

TEST_CASE("names are in natural order, and numbers go row by row on the plan") {
  CHECK(natural_less("desk 2", "desk 10"));
  CHECK_FALSE(natural_less("desk 10", "desk 2"));
  CHECK(natural_less("desk", "desk 1"));
  CHECK(natural_less("a2b", "a10a"));
  CHECK(natural_less("desk 02", "desk 3"));
  CHECK(natural_less("floor", "wall"));
  CHECK_FALSE(natural_less("desk 2", "desk 2"));
  House h = house();
  for (const float y : {1.0f, 3.0f, 5.0f, 7.0f})
    for (const float x : {4.0f, 2.0f, 0.5f})
      h.body({x, y, 0.7f}, {x + 1.4f, y + 0.7f, 0.74f}, "desk");
  const FoundSurfaces found = find_surfaces(PreparedScene(Scene(h.scene)), up, "none", 0.75);
  REQUIRE(found.surfaces.size() == 13);
  for (int i = 0; i < 12; ++i)
    CHECK(found.surfaces[size_t(i)].name == "desk " + std::to_string(i + 1));
  CHECK(found.surfaces[0].corner.y == doctest::Approx(7));
  CHECK(found.surfaces[0].corner.x == doctest::Approx(0.5));
  CHECK(found.surfaces[2].corner.x == doctest::Approx(4));
  CHECK(found.surfaces[11].corner.y == doctest::Approx(1));
}

}  // namespace test_find_floors
