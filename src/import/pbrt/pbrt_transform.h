// Transform directives of pbrt files.
//
// References: [1] pbrt-v4 Input File Format, section "Transformations", pbrt.org/fileformat-v4.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/transform.h"
#include "import/pbrt/pbrt_tokens.h"

namespace troffer {

struct PbrtTransform {
  Affine value;
  bool is_absolute = false;  // takes the place of the current transform, else multiplied from right
};

// Reads the numbers of Identity, Translate, Scale, Rotate, LookAt, Transform or ConcatTransform;
// none for any other word. InputError: missing or infinite numbers, a view direction along `up`,
// projective matrices.
std::optional<PbrtTransform> parse_transform(const PbrtToken& directive, PbrtTokenizer& tokens);

// `count` finite numbers, with or without brackets around them.
std::vector<double> parse_numbers(PbrtTokenizer& tokens, size_t count, std::string_view directive);

}  // namespace troffer
