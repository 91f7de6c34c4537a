// LDR-FLIP: the visible difference of two images when alternating between them, for each pixel in
// [0,1]. compare_images() averages it and flip_map() shows it.
// References: [1] Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström & Fairchild, "FLIP: A
//   Difference Evaluator for Alternating Images", Proc. ACM CGIT 3(2) (HPG), 2020.
#pragma once

#include <vector>

#include "image/image.h"

namespace troffer {

// Pixels per degree of visual angle, for a 0.7 m wide 4K display seen from 0.7 m [1].
constexpr double default_pixels_per_degree = 67;

// Returns FLIP of every pixel, row-major, in [0,1]; symmetric, 0 for equal images. The linear
// images must have equal size. They are clamped to [0,1] without tone map or rounding to 8 bits. A
// pixel with a non-finite component counts as black. Pixels beyond the border repeat the border
// pixel.
std::vector<float> flip_errors(const Image& image, const Image& reference,
                               double pixels_per_degree = default_pixels_per_degree,
                               int threads = 0);

}  // namespace troffer
