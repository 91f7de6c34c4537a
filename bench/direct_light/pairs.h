// Pairs of camera hits and flat sources of a scene: what the benchmark measures. Hits come in
// tiles, as in rendering.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shadow/shadow_source.h"
#include "trace/occluders.h"
#include "transport/prepared_scene.h"

namespace troffer::bench {

// A scene prepared for sampling its direct light. Not movable.
struct DirectScene {
  DirectScene(std::string scene_name, Scene s);

  std::string name;
  PreparedScene prepared;
  Occluders occluders;
  std::vector<FlatSource> sources;
  std::vector<double> radiance;               // luminance of each source
  std::vector<const LightPrimitive*> pieces;  // light primitive of each source
  size_t left_out = 0;                        // number of light primitives that are not flat
  double magnitude = 0;                       // largest absolute coordinate, metres
  float reach = 1;  // largest distance of hits in a cluster, metres, as in rendering
};

// The hits of 8 × 8 pixels as arrays of equal length; neighbouring pixels follow each other.
struct Tile {
  std::vector<Vec3> positions, normals, origins;  // normals: geometric, on the viewer's side
  std::vector<uint32_t> samples;                  // number of the viewing ray
  std::vector<uint32_t> geometries;
  std::vector<uint8_t> is_front;
  size_t size() const { return positions.size(); }
};

// The camera's picture.
struct View {
  int width = 256, height = 256;
  int tiles = 64;  // number of tiles, spread over the picture
  int spp = 1;     // viewing rays per pixel
};

// All pairs of hits and sources, as arrays in the order tile, source, receiver.
struct Pairs {
  Pairs(const DirectScene& s, const View& view);

  const DirectScene& scene;
  std::vector<Tile> tiles;
  std::vector<size_t> first;        // first pair of each tile
  std::vector<double> unoccluded;   // exact projected solid angle, sr; closed form in double
  std::vector<uint8_t> is_counted;  // pairs that count for errors
  std::vector<float> reference;     // visible share; -1 if not counted
  size_t hits = 0;
  size_t reachable = 0;  // number of pairs that light could reach; times are divided by it
  size_t counted = 0;
  size_t in_plane = 0;  // number of pairs that would count, but lie in the source's plane

  size_t size() const { return unoccluded.size(); }
  size_t index(size_t tile, size_t source, size_t receiver) const {
    return first[tile] + source * tiles[tile].size() + receiver;
  }
};

// Returns the random stream of a pair.
uint64_t stream_of(const Tile& tile, size_t receiver, size_t source, uint64_t seed);

}  // namespace troffer::bench
