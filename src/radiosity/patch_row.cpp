#include "radiosity/patch_row.h"

namespace troffer {

size_t RowChunk::bytes() const {
  return sizeof(*this) + view.capacity() * sizeof(BlockView) + first.capacity() * sizeof(uint16_t) +
         visible.capacity() + points.capacity() * sizeof(NearPoint) +
         parts.capacity() * sizeof(NearPart);
}

RowShooter::RowShooter(const RadiosityMesh& mesh, uint32_t patch, const Shooter& shooter,
                       const std::vector<ShooterCell>& patch_cells, float luminance,
                       uint64_t random_stream)
    : cells(patch_cells),
      bounds(cells, shooter),
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
  if (shooter.is_exact && p.last_point - p.first_point <= most_parts)
    parts = {mesh.points.data() + p.first_point, p.last_point - p.first_point};
}

}  // namespace troffer
