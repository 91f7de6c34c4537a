// Transform directives of pbrt files. Used by PbrtInterpreter, which keeps the current transform.
// Angles in files are degrees.
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
  // replaces the current transform; otherwise it is multiplied from the right
  bool is_absolute = false;
};

// Reads the numbers of Identity, Translate, Scale, Rotate, LookAt, Transform or ConcatTransform.
// Returns nothing for any other word. Throws InputError for missing or infinite numbers, for a view
// direction along `up`, and for projective matrices.
std::optional<PbrtTransform> parse_transform(const PbrtToken& directive, PbrtTokenizer& tokens);

// Reads `count` finite numbers, with or without brackets around them.
std::vector<double> parse_numbers(PbrtTokenizer& tokens, size_t count, std::string_view directive);

}  // namespace troffer
