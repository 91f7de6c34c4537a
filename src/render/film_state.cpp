// Saving and loading of a film's pixels (film.h).
#include <cmath>

#include "render/film.h"

namespace troffer {

namespace {

// Stored form of a pixel, without padding between members: padding has undefined bytes.
struct PixelBytes {
  Vec3d direct, indirect;
  double luminance, luminance_squared, source_variance, shared_error, drawn_error, untold,
      without_error_squared;
  uint32_t samples, flags;
};
static_assert(sizeof(PixelBytes) == 112);

struct FirstHitBytes {
  Vec3d albedo, normal, position, sources;
  double depth, shadow_rays;
  uint32_t hits, unused;
};
static_assert(sizeof(FirstHitBytes) == 120);

constexpr uint32_t has_variance_flag = 1, has_whole_error_flag = 2;

}  // namespace

size_t Film::bytes_of_pixel() const {
  static_assert(sizeof(Known) == 116);
  return sizeof(PixelBytes) + (first_hits_.empty() ? 0 : sizeof(FirstHitBytes)) +
         (known_.empty() ? 0 : sizeof(Known));
}

void Film::save(int x, int y, std::vector<uint8_t>& out) const {
  const size_t i = index(x, y);
  const Pixel& p = pixels_[i];
  append(out, PixelBytes{p.direct, p.indirect, p.sum_luminance, p.sum_luminance_squared,
                         p.source_variance, p.shared_error, p.drawn_error, p.untold,
                         p.without_error_squared, p.samples,
                         (p.has_source_variance ? has_variance_flag : 0) |
                             (p.has_whole_error ? has_whole_error_flag : 0)});
  if (!first_hits_.empty()) {
    const FirstHit& f = first_hits_[i];
    append(out, FirstHitBytes{f.albedo, f.normal, f.position, f.sources, f.depth, f.shadow_rays,
                              f.hits, 0});
  }
  if (!known_.empty()) append(out, known_[i]);
}

bool Film::load(int x, int y, ByteReader& in) {
  const size_t i = index(x, y);
  const auto b = in.next<PixelBytes>();
  Pixel& p = pixels_[i];
  p.direct = b.direct;
  p.indirect = b.indirect;
  p.sum_luminance = b.luminance;
  p.sum_luminance_squared = b.luminance_squared;
  p.source_variance = b.source_variance;
  p.shared_error = b.shared_error;
  p.drawn_error = b.drawn_error;
  p.untold = b.untold;
  p.without_error_squared = b.without_error_squared;
  p.samples = b.samples;
  p.has_source_variance = (b.flags & has_variance_flag) != 0;
  p.has_whole_error = (b.flags & has_whole_error_flag) != 0;
  bool is_sound = b.flags <= (has_variance_flag | has_whole_error_flag);
  for (const double v : {p.direct.x, p.direct.y, p.direct.z, p.indirect.x, p.indirect.y,
                         p.indirect.z, p.sum_luminance, p.sum_luminance_squared})
    is_sound = is_sound && std::isfinite(v);
  if (!first_hits_.empty()) {
    const auto f = in.next<FirstHitBytes>();
    first_hits_[i] = {f.albedo, f.normal, f.position, f.sources, f.depth, f.shadow_rays, f.hits};
    is_sound = is_sound && f.unused == 0;
  }
  if (!known_.empty()) {
    known_[i] = in.next<Known>();
    const uint32_t size = known_[i].block_size;
    is_sound = is_sound && (size == 4 || size == 16 || size == 64);
  }
  return is_sound;
}

}  // namespace troffer
