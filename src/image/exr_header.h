// Checks an EXR header before OpenEXR reads it. OpenEXR allocates memory for the sizes that a
// header claims, and its own limits are process-wide settings. All EXR readers here call it first.
// References: [1] "OpenEXR File Layout", openexr.com.
#pragma once

#include "image/decode.h"

namespace troffer {

// Throws InputError unless every part's header is well formed and has at most encoded.max_pixels
// pixels and buffers of reasonable size. The file must be long enough for its table of chunks.
// Rejects deep data.
void check_exr_header(const EncodedImage& encoded);

// Name of the attribute for WriteOptions::note.
constexpr const char* note_attribute = "troffer";

}  // namespace troffer
