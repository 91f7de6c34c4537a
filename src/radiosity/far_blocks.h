// Blocks of receivers far from a patch: what of its cells they see, all, nothing or a share per
// point, by rays that all blocks of a chunk cast together.
#pragma once

#include "radiosity/patch_row.h"

namespace troffer {

class FarBlocks {
 public:
  // For a patch's row; its memory serves one after the other.
  void begin(const RowContext& row);
  void start(size_t block);
  // The same for a block near to the patch; false, with nothing done, where it is so near that
  // cells say little, or gets so much that their error would show.
  bool start_weak(size_t block);
  // Of all blocks that were started. first_block: the chunk's.
  void finish(size_t first_block, RowChunk& out);
  uint64_t rays() const { return rays_; }

 private:
  struct Block {
    uint32_t block;
    int wanted = 1;
    float irradiance[ReceiverBlock::most_points];  // luminance
    float all[ReceiverBlock::most_points] = {}, visible[ReceiverBlock::most_points] = {};
  };
  // What a ray is cast for: the points [first, last) of a block.
  struct Purpose {
    uint32_t block;
    uint8_t first, last, point, k;  // of its block: whose place it starts from; a point's k-th
    uint32_t cell;                  // to which …
    Vec2 u;                         // … and to where on it
    uint64_t hash;
    float weight;
  };
  // What the points of the block get; returns the most.
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
  uint64_t phase_ = 0;  // where numbers that are spread over neighbouring points start
  uint64_t rays_ = 0;
  std::vector<Block> blocks_;
  std::vector<Ray> ray_list_;
  std::vector<Purpose> purposes_;  // of ray_list_
  std::vector<uint8_t> occluded_;
  PaneFactors factors_;
};

}  // namespace troffer
