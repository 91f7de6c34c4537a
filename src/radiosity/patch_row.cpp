#include "radiosity/patch_row.h"

#include <bit>

#include "base/units.h"

namespace troffer {

uint16_t dark_bits(float most) {
  return uint16_t((std::bit_cast<uint32_t>(most) >> 16) + 1);
}

float dark_most(uint16_t bits) {
  return std::bit_cast<float>(uint32_t(bits) << 16);
}

namespace {

std::vector<ShooterCell> make_even(std::vector<ShooterCell> cells) {
  for (ShooterCell& c : cells) c.share = 1;
  return cells;
}

}  // namespace

bool is_near(const RowShooter& s, const ReceiverBlock& b, float cell_radii) {
  const float cell = cell_radii * s.bounds.cell_radius + b.radius;
  if (length_squared(b.centre - s.bounds.centre) >= sqr(s.bounds.radius + cell)) return false;
  for (const ShooterCell& c : s.cells)
    if (length_squared(c.position - b.centre) < sqr(cell)) return true;
  return false;
}

void RowChunk::clear(size_t blocks) {
  view.assign(blocks, BlockView::none);
  first.assign(blocks, 0);
  visible.clear();
  points.clear();
  parts.clear();
}

size_t RowChunk::bytes() const {
  return sizeof(*this) + view.capacity() * sizeof(BlockView) + first.capacity() * sizeof(uint16_t) +
         visible.capacity() + points.capacity() * sizeof(NearPoint) +
         parts.capacity() * sizeof(NearPart);
}

RowShooter::RowShooter(const RadiosityMesh& mesh, const Receivers& receivers, uint32_t patch,
                       const Shooter& shooter, const std::vector<ShooterCell>& patch_cells,
                       float luminance, uint64_t random_stream)
    : cells(patch_cells),
      bounds(cells, shooter),
      levels(make_even(cells), bounds),
      even(shooter),
      expected(luminance),
      stream(random_stream) {
  constexpr uint32_t most_parts = 256;
  double sum = 0;
  for (ShooterCell& c : cells) {
    sent.push_back(sum += double(c.area) * double(c.share));
    c.share = 1;
  }
  even.share.clear();
  even.parts = {};
  for (LightPrimitive& p : even.pieces) p.mean_radiance = Rgb{expected};
  const Patch& p = mesh.patches[patch];
  if (shooter.is_exact && p.last_point - p.first_point <= most_parts) {
    first_slot = receivers.first_slot[patch];
    parts = {mesh.points.data() + p.first_point, p.last_point - p.first_point};
  }
}

}  // namespace troffer
