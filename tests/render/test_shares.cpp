// Shares of a picture: together they are the whole picture, each pixel once, with the same bits.
#include <doctest/doctest.h>

#include <cstring>

#include "base/error.h"
#include "import/import.h"
#include "render/edge_map.h"
#include "render/framing.h"
#include "render/pictures.h"
#include "render/tile.h"

using namespace troffer;
using namespace troffer::test;

namespace {

TileRules rules(int side, bool has_whole_tiles) {
  TileRules r;
  r.side = side;
  r.has_whole_tiles = has_whole_tiles;
  return r;
}

// Joins all shares.
std::vector<Layer> joined(const PreparedScene& scene, const Camera& camera, RenderOptions o,
                          int parts) {
  std::vector<Layer> all;
  const RenderOptions whole = o;
  const int x0 = o.has_crop ? o.crop[0] : 0, y0 = o.has_crop ? o.crop[1] : 0;
  const int width = o.has_crop ? o.crop[2] - x0 : o.width,
            height = o.has_crop ? o.crop[3] - y0 : o.height;
  o.parts = parts;
  for (o.part = 1; o.part <= parts; ++o.part) {
    o.threads = 1 + o.part % 3;
    const RenderResult share = render_now(scene, camera, o);
    if (all.empty())
      for (const Layer& l : share.layers)
        all.push_back({l.name, l.channels, Image(width, height, Rgb{-1})});
    for (size_t l = 0; l < all.size(); ++l)
      for (int y = share.window[1]; y < share.window[3]; ++y)
        for (int x = share.window[0]; x < share.window[2]; ++x)
          all[l].image.at(x - x0, y - y0) =
              share.layers[l].image.at(x - share.window[0], y - share.window[1]);
  }
  return all;
}

void check_shares(const RenderOptions& o, int parts) {
  const PreparedScene scene(mixed_room());
  const RenderResult whole = render_now(scene, mixed_room_camera(), o);
  CAPTURE(std::string(o.method.row().name));
  CHECK(is_identical(joined(scene, mixed_room_camera(), o, parts), whole.layers));
}

RenderOptions options_for(Method method, int width, int height) {
  RenderOptions o;
  o.method = method;
  o.width = width;
  o.height = height;
  o.aovs = {Aov::normal, Aov::direct, Aov::error, Aov::viewing_error};
  o.shadow_rays = 4;
  o.kj92.radiosity.meshing.element_size = 0.4f;
  o.kj92.radiosity.meshing.patch_size = 1.2f;
  o.kj92.radiosity.unshot_fraction = 0.05f;
  return o;
}

}  // namespace

TEST_CASE("parts cover the requested pixels once each, and are about equally large") {
  for (const PixelRect& asked : {PixelRect{0, 0, 64, 48}, {5, 3, 100, 30}, {17, 9, 18, 200}})
    for (const bool has_whole_tiles : {false, true})
      for (const int side : {8, 16})
        for (const int parts : {1, 2, 3, 5, 7, 11}) {
          std::vector<int> count(200 * 200, 0);
          const TileRules r = rules(side, has_whole_tiles);
          const int x = has_whole_tiles ? 0 : asked.x0, y = has_whole_tiles ? 0 : asked.y0;
          size_t smallest = 200 * 200, largest = 0;
          bool is_possible = true;
          for (int part = 1; part <= parts && is_possible; ++part) {
            PixelRect share;
            try {
              share = share_of(asked, r, part, parts);
            } catch (const UsageError&) {
              CHECK(part == 1);
              is_possible = false;
              continue;
            }
            const size_t pixels = size_t(share.width()) * size_t(share.height());
            CHECK(pixels > 0);
            smallest = std::min(smallest, pixels);
            largest = std::max(largest, pixels);
            // Cut between tiles.
            CHECK((share.x0 == asked.x0 || (share.x0 - x) % side == 0));
            CHECK((share.y1 == asked.y1 || (share.y1 - y) % side == 0));
            for (int j = share.y0; j < share.y1; ++j)
              for (int i = share.x0; i < share.x1; ++i) ++count[size_t(j * 200 + i)];
          }
          if (!is_possible) continue;
          size_t wrong = 0;
          for (int j = 0; j < 200; ++j)
            for (int i = 0; i < 200; ++i) {
              const bool is_asked = i >= asked.x0 && i < asked.x1 && j >= asked.y0 && j < asked.y1;
              wrong += count[size_t(j * 200 + i)] != (is_asked ? 1 : 0);
            }
          CHECK(wrong == 0);
          if (asked.width() == 64 && side == 8) CHECK(largest <= 2 * smallest);
        }
  CHECK_THROWS_AS(share_of({0, 0, 16, 16}, rules(8, true), 1, 5), UsageError);
  for (int part = 1; part <= 4; ++part)  // one tile each
    CHECK(share_of({0, 0, 16, 16}, rules(8, true), part, 4).width() == 8);
}

TEST_CASE("merged parts equal the whole picture bit for bit, by every method") {
  for (const Method method : {Method::path, Method::fixed}) {
    RenderOptions o = options_for(method, 53, 37);
    check_shares(o, 4);
    o.max_spp = 16;
    check_shares(o, 3);
  }
  RenderOptions o = options_for(Method::kj92, 40, 33);
  o.spp = 2;
  o.kj92.sampling.tree.allowed_variance = 0.1f;
  check_shares(o, 3);
  o.max_spp = 8;  // refinement depends on the whole picture
  check_shares(o, 3);
  o.has_crop = true;
  o.crop = {3, 5, 38, 30};
  check_shares(o, 3);
}

TEST_CASE(
    "merged parts equal the whole by default, for a picture larger than the gather neighbourhood") {
  RenderOptions o = options_for(Method::certified, 152, 24);
  o.error = 0.05;
  check_shares(o, 3);
  o.has_crop = true;
  o.crop = {13, 3, 140, 21};
  o.indirect = Indirect::none;
  check_shares(o, 4);
}

// Lamps in the plane of the ceiling behind wires; some sides lie along borders of pixels.
TEST_CASE("outlines of lamps are the same for every region of the picture") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-4, -4, -3}, {4, -4, -3}, {4, 4, -3}, {-4, 4, -3}});
  for (int i = 0; i < 60; ++i) {
    const float x = -3.5f + 0.7f * float(i % 10), y = -2 + 0.75f * float(i / 10), r = 0.25f;
    const uint32_t quad = add_quad(
        s, grey,
        {Vec3{x - r, y - r, -3}, {x + r, y - r, -3}, {x + r, y + r, -3}, {x - r, y + r, -3}});
    make_light(s, quad, Rgb{1});
  }
  for (int i = 0; i < 12; ++i) {
    const float y = -2 + 0.37f * float(i);
    add_quad(s, grey,
             {Vec3{-4, y, -2}, {4, y + 0.3f, -2}, {4, y + 0.32f, -2}, {-4, y + 0.02f, -2}});
  }
  const PreparedScene scene(std::move(s));
  const ViewingCamera camera(look_at({0, 0, 0}, {0, 0, -3}, {0, 1, 0}, 60), 192, 128);
  const LightOutlines whole(scene, camera, {0, 0, 192, 128}, true, 2);
  size_t known = 0, unknown = 0, off = 0;
  for (int x0 = 1; x0 < 96; x0 += 5) {
    const PixelRect region{x0, 40, x0 + 64, 70};
    const LightOutlines part(scene, camera, region, true, 1);
    for (int y = region.y0; y < region.y1; ++y)
      for (int x = region.x0; x < region.x1; ++x) {
        known += whole.is_known(x, y) ? 1 : 0;
        unknown += whole.has_outline(x, y) && !whole.is_known(x, y) ? 1 : 0;
        off += part.has_outline(x, y) != whole.has_outline(x, y) ? 1 : 0;
        off += part.is_known(x, y) != whole.is_known(x, y) ? 1 : 0;
        for (const Vec2& place : {Vec2{0.1f, 0.2f}, {0.7f, 0.6f}})
          off += part.edge_correction(x, y, place, Rgb{0}) ==
                         whole.edge_correction(x, y, place, Rgb{0})
                     ? 0
                     : 1;
      }
  }
  CHECK(known > 100);
  CHECK(unknown > 100);
  CHECK(off == 0);
}

// The mullions of the window lie exactly on corners of pixels.
TEST_CASE(
    "edges through pixels are the same for every region of the picture, also where rays tie") {
  const std::string folder = TROFFER_SOURCE_DIR "/scenes/daylight-room/";
  const PreparedScene scene(import_scene(folder + "daylight-room.gltf"));
  const ViewingCamera camera(framing_camera(scene, {0, 1, 0}), 192, 128);
  const auto map_of = [&](const PixelRect& region) {
    return EdgeMap(scene, camera, region, LightOutlines(scene, camera, region, true, 1), 2);
  };
  const EdgeMap whole = map_of({0, 0, 192, 128});
  size_t edges = 0, off = 0;
  for (int x0 = 1; x0 < 96; x0 += 5) {
    const PixelRect region{x0, 40, x0 + 64, 70};
    const EdgeMap part = map_of(region);
    for (int y = region.y0; y < region.y1; ++y)
      for (int x = region.x0; x < region.x1; ++x) {
        edges += whole.has_surface_edge(x, y) ? 1 : 0;
        off += part.has_surface_edge(x, y) != whole.has_surface_edge(x, y) ? 1 : 0;
        off += part.has_light_edge(x, y) != whole.has_light_edge(x, y) ? 1 : 0;
        off += part.has_unknown_light_edge(x, y) != whole.has_unknown_light_edge(x, y) ? 1 : 0;
      }
  }
  CHECK(edges > 100);
  CHECK(off == 0);
}
