// What is measured: hits of a camera, in tiles as rendering has them, each paired with every flat
// source of a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shadow/shadow_source.h"
#include "trace/occluders.h"
#include "transport/prepared_scene.h"

namespace troffer::bench {

// A scene and all that sampling its direct light stands on. Stays where it is.
struct DirectScene {
  DirectScene(std::string scene_name, Scene s);

  std::string name;
  PreparedScene prepared;
  Occluders occluders;
  std::vector<FlatSource> sources;
  std::vector<double> radiance;               // of each source, luminance
  std::vector<const LightPrimitive*> pieces;  // what each source was made of
  size_t left_out = 0;                        // pieces of lights that are not flat
  double magnitude = 0;                       // largest absolute coordinate, metres
  float reach = 1;  // by which hits of a cluster may lie apart, as in rendering
};

// The hits of 8 × 8 pixels, each pixel next to the one before: plain arrays of one length.
struct Tile {
  std::vector<Vec3> positions, normals, origins;  // normals: geometric, on the viewer's side
  std::vector<uint32_t> samples;                  // number of the viewing ray
  std::vector<uint32_t> geometries;
  std::vector<uint8_t> is_front;
  size_t size() const { return positions.size(); }
};

struct View {
  int width = 256, height = 256;
  int tiles = 64;  // spread over the picture
  int spp = 1;     // viewing rays per pixel
};

// All pairs of hit and source. Plain arrays over pairs, in the order tile, source, receiver.
struct Pairs {
  Pairs(const DirectScene& s, const View& view);

  const DirectScene& scene;
  std::vector<Tile> tiles;
  std::vector<size_t> first;        // per tile
  std::vector<double> unoccluded;   // exact projected solid angle, sr; closed form in double
  std::vector<uint8_t> is_counted;  // errors are taken over these
  std::vector<float> reference;     // visible share; -1 where not counted
  size_t hits = 0;
  size_t reachable = 0;  // pairs that some light could reach: what times are divided by
  size_t counted = 0;
  size_t in_plane = 0;  // pairs that would count, but lie in the source's plane

  size_t size() const { return unoccluded.size(); }
  size_t index(size_t tile, size_t source, size_t receiver) const {
    return first[tile] + source * tiles[tile].size() + receiver;
  }
};

// Names a pair's random numbers.
uint64_t stream_of(const Tile& tile, size_t receiver, size_t source, uint64_t seed);

}  // namespace troffer::bench
