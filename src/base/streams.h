// Registry of random streams: one name for every independent use of random numbers.
//
// A stream is hash_of(seed or parent stream, ids…, purpose) (base/random.h). Two uses never share a
// purpose, so their numbers are independent even for equal ids. Estimates use streams that derive
// from the user's seed. The streams at the end are fixed on purpose: they only decide, so that the
// same scene is treated alike for every seed. The test `streams` compares this list with the code.
#pragma once

#include <cstdint>

namespace troffer::stream {

// Pictures; derived from the seed.
inline constexpr uint64_t gap_filler = 0x6761'7073;
inline constexpr uint64_t preview = 0x6c6f'6f6b;
inline constexpr uint64_t surrogate_rays = 0x676c'616e;
inline constexpr uint64_t further_test = 0x6675'7274;
inline constexpr uint64_t further_like_first = 0x6675'7266'0000'0000;  // + an index under 2^32
inline constexpr uint64_t typical_luminance = 0x7479'7069;
inline constexpr uint64_t path_forecast = 0x7061'7468;
inline constexpr uint64_t learned_lights = 0x6c65'6172;
inline constexpr uint64_t gather_trial = 0x7472'6961;
inline constexpr uint64_t outline_check = 0x6f75'746c;

// Measured points and baked light; derived from the seed.
inline constexpr uint64_t measuring_rounds = 0x6175'6469;
inline constexpr uint64_t bake_sites = 0x7369'7465;
inline constexpr uint64_t bake_enclosure = 0x626c'6f6f;
inline constexpr uint64_t bake_sides = 0x7369'6465;

// Cells and gathering; derived from the seed.
inline constexpr uint64_t picture_pilot = 0x7069'6374;
inline constexpr uint64_t surfaces_pilot = 0x7375'7266;
inline constexpr uint64_t cell_pilot_rays = 0x7069'6c6f;
inline constexpr uint64_t cell_rows = 0x726f'7773;
inline constexpr uint64_t cell_row_refinement = 0x7265'6669;
inline constexpr uint64_t direct_light_of_cells = 0x6365'6c6c;
inline constexpr uint64_t light_samples_of_cells = 0x6472'6177;
inline constexpr uint64_t direct_light_of_places = 0x706c'6163;
inline constexpr uint64_t noise_signs = 0x6e6f'6973;
inline constexpr uint64_t narrow_cells_test = 0x6e61'7272;
inline constexpr uint64_t gather_records = 0x7669'6577;
inline constexpr uint64_t thinning_sight = 0x636c'6f73;
inline constexpr uint64_t thinning_rays = 0x636c'6f74;

// Annual daylight; derived from the seed.
inline constexpr uint64_t annual_replicates = 0x616e'6e75;
inline constexpr uint64_t annual_gather = 0x616e'6e67;
inline constexpr uint64_t annual_rows = 0x616e'6e72;
inline constexpr uint64_t annual_cell_light = 0x616e'6e63;
inline constexpr uint64_t annual_cell_places = 0x616e'6e70;
inline constexpr uint64_t annual_sun_grid = 0x616e'6e6e;
inline constexpr uint64_t annual_direct_sky = 0x616e'6e64;
inline constexpr uint64_t annual_direct_ground = 0x616e'6e74;
inline constexpr uint64_t annual_direct_sun = 0x616e'6e73;
inline constexpr uint64_t annual_eye_sky = 0x616e'6579;
inline constexpr uint64_t annual_eye_sun = 0x616e'657a;
inline constexpr uint64_t annual_eye_view = 0x616e'6576;
inline constexpr uint64_t annual_eye_walks = 0x616e'6577;

// Parts of a sample; derived from the stream of its pixel or point.
inline constexpr uint64_t far_side = 0x6661'7220'7369'6465;
inline constexpr uint64_t mirror_image_of_hit = 0x696d'6167;
inline constexpr uint64_t mirror_image_of_arrival = 0x696d'6761;
inline constexpr uint64_t mirror_image_of_path = 0x696d'6770;
inline constexpr uint64_t end_at_cell = 0x656e'6463;
inline constexpr uint64_t matte_light_samples = 0x6d61'7474;
inline constexpr uint64_t reduced_light_samples = 0x7468'7269'0000;  // + an index under 2^16
inline constexpr uint64_t reduced_gather_rays = 0x7468'7266'0000;    // + an index under 2^16
inline constexpr uint64_t open_sky_parts = 0x6661'7200;
inline constexpr uint64_t environment_rays = 0x6661'7270'0000;  // + an index under 2^16
inline constexpr uint64_t environment_pilot = 0x6661'7271;
inline constexpr uint64_t sun_pilot = 0x6661'7272;
inline constexpr uint64_t source_pilot = 0x7069'6c6f'7400;
inline constexpr uint64_t mask_shift = 0x5851'f42d'4c95'7f2d;
inline constexpr uint64_t mask_points = 0x1405'7b7e'f767'814f;

// Fixed: they decide about a scene and enter no estimate.
inline constexpr uint64_t mirror_candidates = 0x6d69'7272;
inline constexpr uint64_t mirror_light = 0x6d69'7277;
inline constexpr uint64_t lit_surfaces = 0x6c69'7470;
inline constexpr uint64_t cut_off_texels = 0x6e65'6172;

}  // namespace troffer::stream
