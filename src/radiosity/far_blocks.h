// Visibility between a patch and distant blocks of receivers. The patch is represented by its
// cells. A block sees all, nothing, or a share per point; the rays of a chunk's blocks are traced
// together.
#pragma once

#include "radiosity/patch_row.h"

namespace troffer {

class FarBlocks {
 public:
  // Starts a patch's row. Buffers are reused from row to row.
  void begin(const RowContext& row);
  void start(size_t block);
  // Starts a block near the patch. Returns false and does nothing if the block is so near, or so
  // bright, that the error of the cells would show.
  bool start_if_weak(size_t block);
  // Traces the rays of all started blocks and writes the result. first_block: the chunk's first
  // block.
  void finish(size_t first_block, RowChunk& out);
  uint64_t rays() const { return rays_; }

 private:
  struct Block {
    uint32_t block;
    int wanted = 1;
    float irradiance[ReceiverBlock::most_points];  // luminance
    float all[ReceiverBlock::most_points] = {}, visible[ReceiverBlock::most_points] = {};
  };
  // Target of one ray: it stands for the points [first, last) of a block.
  struct Purpose {
    uint32_t block;
    uint8_t first, last, point, k;  // point: the ray's origin in the block; k: index of the ray
    uint32_t cell;                  // target cell
    Vec2 u;                         // position on the cell
    uint64_t hash;
    float weight;
  };
  // Computes the unoccluded irradiance of the block's points; returns the maximum.
  float find_irradiance(Block& f) const;
  void add(const Block& f);
  static bool is_unanimous(const Block& f, uint32_t count, bool& is_lit);
  void add_ray(uint32_t index, uint8_t first, uint8_t last, int k);
  void aim(Purpose& p) const;
  bool find_ray(Purpose& p);
  void trace();
  void settle(const Block& f, size_t first_block, RowChunk& out) const;
  void note_seen(const Block& f, uint32_t i, float share) const;

  const RowContext* row_ = nullptr;
  uint64_t phase_ = 0;  // start of the golden-ratio sequence over neighbouring points
  uint64_t rays_ = 0;
  std::vector<Block> blocks_;
  std::vector<Ray> ray_list_;
  std::vector<Purpose> purposes_;  // per ray of ray_list_
  std::vector<uint8_t> occluded_;
  PaneFactors factors_;
};

}  // namespace troffer
