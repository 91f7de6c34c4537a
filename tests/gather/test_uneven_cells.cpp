// Halving of cells where something stands close above a part of them.
#include <doctest/doctest.h>

#include "gather/uneven_cells.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns a piece of the floor, 20 cm wide, from x to x + .2, facing up.
CellOutline piece(float x) {
  CellOutline cell;
  cell.corners = {Vec3{x, 0.4f, 0}, {x + 0.2f, 0.4f, 0}, {x + 0.2f, 0.6f, 0}, {x, 0.6f, 0}};
  cell.normal = {0, 0, 1};
  cell.offset = 1e-5f;
  return cell;
}

Scene floor_of_a_metre() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  return s;
}

// Adds a sheet at height z above the floor.
void add_sheet(Scene& s, float x0, float x1, float z) {
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{x0, 0, z}, {x0, 1, z}, {x1, 1, z}, {x1, 0, z}});
}

}  // namespace

TEST_CASE(
    "cells with a close cover above a part of them count as uneven where the view needs them") {
  const auto is_uneven = [](float height, float x, float x0, float x1, bool is_asked = true) {
    Scene s = floor_of_a_metre();
    add_sheet(s, x0, x1, height);
    const PreparedScene scene(std::move(s));
    return uneven_cells(scene)(piece(x), is_asked);
  };
  CHECK(is_uneven(0.08f, 0.4f, 0.5f, 1));          // covers half of it
  CHECK(is_uneven(0.08f, 0.4f, 0.48f, 0.53f));     // covers a strip
  CHECK(!is_uneven(0.08f, 0.4f, 0.5f, 1, false));  // the picture does not look at it
  CHECK(!is_uneven(0.08f, 0.7f, 0.5f, 1));         // covers all of it
  CHECK(!is_uneven(0.08f, 0.1f, 0.5f, 1));         // covers none of it
  CHECK(!is_uneven(0.3f, 0.4f, 0.5f, 1));          // too high to matter
  CHECK(!is_uneven(0.01f, 0.4f, 0.5f, 1));         // too low for any light below it
}

TEST_CASE("an object that stands on a surface does not cover it") {
  Scene s = floor_of_a_metre();
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0.5f, 0, 0}, {1, 1, 0.08f});
  const PreparedScene scene(std::move(s));
  CHECK(!uneven_cells(scene)(piece(0.4f), true));
}
