// A look at an EXR header before OpenEXR acts on it: OpenEXR reserves memory for what a header
// claims, and its own limits are process-wide settings.
// References: [1] "OpenEXR File Layout", openexr.com.
#pragma once

#include "image/decode.h"

namespace troffer {

// Throws InputError unless every part's header is well formed, has pixels within
// encoded.max_pixels, needs buffers of sane size, and the file is long enough for its table of
// chunks. Also refuses deep data, by name.
void check_exr_header(const EncodedImage& encoded);

// Where WriteOptions::note stands.
constexpr const char* note_attribute = "troffer";

}  // namespace troffer
