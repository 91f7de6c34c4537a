// Warnings for points and luminaires outside of the room or inside an object, and none for others.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <array>

#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_misplaced {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

// A box whose faces look inward, or outward, with corners from `a` to `b`; its vertices follow
// `first` others.
std::string box(const std::array<double, 3>& a, const std::array<double, 3>& b, int first,
                bool is_inward, bool has_lid = true) {
  std::string s;
  for (const double z : {a[2], b[2]})
    for (const auto& [x, y] : {std::pair{a[0], a[1]}, {b[0], a[1]}, {b[0], b[1]}, {a[0], b[1]}})
      s += fmt::format("v {} {} {}\n", x, y, z);
  const int faces[6][4] = {{1, 2, 3, 4}, {5, 8, 7, 6}, {1, 5, 6, 2},
                           {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}};
  for (int f = 0; f < 6; ++f) {
    if (f == 1 && !has_lid) continue;
    s += "f";
    for (int k = 0; k < 4; ++k) s += fmt::format(" {}", first + faces[f][is_inward ? k : 3 - k]);
    s += "\n";
  }
  return s;
}

const char* const point_ies =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n100 100\n";
const char* const panel_ies =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 .6 .6 0\n1 1 5\n0 90\n0\n100 100\n";

struct PlaceTest {
  Folder folder;
  std::string point = folder.write("point.ies", point_ies);
  std::string panel = folder.write("panel.ies", panel_ies);
  // A room of 6 × 4 × 3 m, in which a solid of one cubic metre hangs.
  std::string room = folder.write(
      "room.obj", box({0, 0, 0}, {6, 4, 3}, 0, true) + box({1, 1, 0.2}, {2, 2, 1.2}, 8, false));

  std::string warnings(const std::string& scene, const std::string& luminaires,
                       const std::string& points, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{
        "measure",    scene, "--points", folder.write("p.csv", "x,y,z,nx,ny,nz\n" + points),
        "--spp",      "16",  "--up",     "0,0,1",
        "--indirect", "none"};
    if (!luminaires.empty()) {
      words.emplace_back("--luminaires");
      words.push_back(folder.write("list.csv", "file,x,y,z\n" + luminaires));
    }
    words.insert(words.end(), more.begin(), more.end());
    const Finished f = run_program(folder, words);
    CAPTURE(f.err);
    CHECK(f.status == 0);
    std::string told;
    for (const std::string& line : f.error_lines())
      if (line.starts_with("warning:")) told += line + "\n";
    return told;
  }
};

}  // namespace

TEST_CASE("points outside of a closed room, or within bodies, are reported by number") {
  PlaceTest t;
  const char* const lamp = "point.ies,3,2,2.5\n";
  CHECK(t.warnings(t.room, lamp, "3,2,0,0,0,1\n3,2,.75,0,0,1\n.1,.1,2.9,0,0,1\n").empty());
  // y and z exchanged: 3.5 m up, above the ceiling.
  const std::string swapped = t.warnings(t.room, lamp, "3,2,0,0,0,1\n3,.75,3.5,0,1,0\n");
  CHECK(contains(swapped, "1 point lies outside of the room (number 2)"));
  CHECK(contains(t.warnings(t.room, lamp, "3,-2,1,0,0,1\n9,9,9,0,0,1\n"),
                 "2 points lie outside of the room (number 1, 2)"));
  CHECK(contains(t.warnings(t.room, lamp, "1.5,1.5,.7,0,0,1\n3,2,.75,0,0,1\n"),
                 "1 point lies within a body, where no light arrives (number 1)"));
  // Daylight without walls: the outside is lit, and the points are reported all the same.
  CHECK(contains(t.warnings(t.room, "", "3,2,5,0,0,1\n", {"--sky", "overcast"}),
                 "1 point lies outside of the room (number 1)"));
  CHECK(t.warnings(t.room, lamp, "3,-2,1,0,0,1\n", {"--quiet"}).empty());
}

TEST_CASE("luminaires outside of a closed room, or within a ceiling, are reported by name") {
  PlaceTest t;
  const char* const floor = "3,2,.75,0,0,1\n";
  for (const char* file : {"point.ies", "panel.ies"}) {
    CAPTURE(file);
    const auto told = [&](const std::string& scene, const std::string& at) {
      return t.warnings(scene, fmt::format("{},3,2,2.5\n{},{}\n", file, file, at), floor);
    };
    CHECK(told(t.room, "1,3,2.9").empty());
    CHECK(contains(told(t.room, "3,2,3.9"), "1 luminaire lies outside of the room: luminaire1"));
    CHECK(contains(told(t.room, "3,2.5,-1"), "outside of the room: luminaire1"));
    // A room with walls and a ceiling half a metre thick.
    const std::string thick =
        t.folder.write("thick.obj", box({0, 0, 0}, {6, 4, 3}, 0, true) +
                                        box({-.5, -.5, -.5}, {6.5, 4.5, 3.5}, 8, false));
    CHECK(told(thick, "1,3,2.9").empty());
    CHECK(contains(told(thick, "3,2,3.9"), "outside of the room: luminaire1"));
    CHECK(contains(told(thick, "3,2,3.2"), "luminaire1"));
    // Inside the solid.
    CHECK(contains(told(t.room, "1.5,1.5,.7"),
                   "1 luminaire lies within a body, or behind a surface"));
  }
  const std::string all = t.warnings(t.room, "point.ies,3,2,3.9\n", floor);
  CHECK(contains(all, "outside of the room: luminaire0"));
}

TEST_CASE("open scenes, and arrangements that only look odd, cause no warning") {
  PlaceTest t;
  const std::string plane =
      t.folder.write("plane.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
  const std::string open = t.folder.write("open.obj", box({0, 0, 0}, {6, 4, 3}, 0, true, false));
  const std::string block = t.folder.write("block.obj", box({0, 0, 0}, {6, 4, 3}, 0, false));
  // Above a plane, above a room without a ceiling, next to a block.
  CHECK(t.warnings(plane, "point.ies,0,0,3\n", "0,0,0,0,0,1\n0,0,9,0,0,1\n20,0,0,0,0,1\n").empty());
  CHECK(t.warnings(open, "panel.ies,3,2,4\n", "3,2,0,0,0,1\n3,2,5,0,0,1\n").empty());
  CHECK(t.warnings(block, "point.ies,9,9,5\n", "3,2,3,0,0,1\n8,8,0,0,0,1\n").empty());
  // Points that a beam does not reach, or that face away, in a room with a lamp.
  CHECK(t.warnings(t.room, "point.ies,3,2,1\n", "3,2,2,0,0,1\n3,2,0,0,0,-1\n").empty());
  // Flush with the ceiling, and a point on the floor.
  CHECK(t.warnings(t.room, "panel.ies,3,2,3\n", "3,2,0,0,0,1\n").empty());
  // A point on a façade under the sky.
  CHECK(t.warnings(plane, "", "0,0,2,0,1,0\n", {"--sky", "overcast"}).empty());
}

}  // namespace test_misplaced
