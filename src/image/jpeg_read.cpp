#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <jpeglib.h>
// Must follow jpeglib.h.
#include <jerror.h>

#include "image/decode.h"

namespace troffer {

namespace {

// Each scan of a progressive file costs a pass over the whole picture. Real files have about ten.
constexpr int max_scans = 100;

struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump{};
  char message[JMSG_LENGTH_MAX] = "";
  const EncodedImage& encoded;
  Raster raster{};
  std::vector<uint8_t> cmyk_row{};

  explicit JpegReader(const EncodedImage& e) : encoded(e) {}
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

JpegReader& reader_of(j_common_ptr jpeg) {
  return *static_cast<JpegReader*>(jpeg->client_data);
}

[[noreturn]] void on_error(j_common_ptr jpeg) {
  JpegReader& reader = reader_of(jpeg);
  jpeg->err->format_message(jpeg, reader.message);
  std::longjmp(reader.jump, 1);
}

// Warnings about missing pixels are errors; others are ignored.
void on_message(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  const int code = jpeg->err->msg_code;
  if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER) on_error(jpeg);
}
void on_output(j_common_ptr) {}

void on_progress(j_common_ptr jpeg) {
  JpegReader& reader = reader_of(jpeg);
  if (reader.jpeg.input_scan_number <= max_scans) return;
  std::snprintf(reader.message, sizeof reader.message, "more than %d scans", max_scans);
  std::longjmp(reader.jump, 1);
}

// Converts CMYK to rgb without a profile: each channel is the product of the light that its ink and
// black pass. Adobe files store 255 - ink.
void rgb_from_cmyk(const uint8_t* cmyk, bool is_inverted, size_t width, uint8_t* rgb) {
  for (size_t x = 0; x < width; ++x)
    for (size_t c = 0; c < 3; ++c) {
      const int ink = cmyk[4 * x + c], black = cmyk[4 * x + 3];
      const int passed = is_inverted ? ink * black : (255 - ink) * (255 - black);
      rgb[3 * x + c] = uint8_t((passed + 127) / 255);
    }
}

void note_profile(jpeg_decompress_struct& jpeg, OwnColours& own) {
  JOCTET* profile = nullptr;
  unsigned length = 0;
  if (jpeg_read_icc_profile(&jpeg, &profile, &length) == FALSE) return;
  const std::unique_ptr<JOCTET, decltype(&std::free)> owner(profile, &std::free);
  own.profile.assign(profile, profile + length);
}

// All calls that libjpeg may leave by longjmp. Returns false after an error.
bool read(JpegReader& reader) {
  jpeg_decompress_struct& jpeg = reader.jpeg;
  if (setjmp(reader.jump) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg.client_data = &reader;
  jpeg.progress = &reader.progress;
  jpeg_mem_src(&jpeg, reader.encoded.bytes.data(), reader.encoded.bytes.size());
  jpeg_save_markers(&jpeg, JPEG_APP0 + 2, 0xffff);  // parts of an ICC profile
  jpeg_read_header(&jpeg, TRUE);
  reader.encoded.check_size(jpeg.image_width, jpeg.image_height);

  const bool is_cmyk = jpeg.num_components == 4;
  jpeg.out_color_space = is_cmyk ? JCS_CMYK : jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_start_decompress(&jpeg);
  Raster& raster = reader.raster;
  raster.width = int(jpeg.output_width);
  raster.height = int(jpeg.output_height);
  raster.channels = jpeg.num_components == 1 ? 1 : 3;
  raster.is_srgb = true;
  note_profile(jpeg, raster.own);
  const size_t row_size = size_t(raster.width) * size_t(raster.channels);
  raster.texels8.resize(row_size * size_t(raster.height));
  if (is_cmyk) reader.cmyk_row.resize(size_t(raster.width) * 4);
  while (jpeg.output_scanline < jpeg.output_height) {
    uint8_t* out = raster.texels8.data() + row_size * jpeg.output_scanline;
    JSAMPROW row = is_cmyk ? reader.cmyk_row.data() : out;
    jpeg_read_scanlines(&jpeg, &row, 1);
    if (is_cmyk) rgb_from_cmyk(row, jpeg.saw_Adobe_marker != 0, size_t(raster.width), out);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

}  // namespace

bool is_jpeg(std::span<const uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

Raster decode_jpeg(const EncodedImage& encoded) {
  JpegReader reader(encoded);
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.jpeg.client_data = &reader;
  reader.errors.error_exit = on_error;
  reader.errors.emit_message = on_message;
  reader.errors.output_message = on_output;
  reader.progress.progress_monitor = on_progress;
  if (!read(reader)) encoded.fail("broken JPEG: " + std::string(reader.message));
  return std::move(reader.raster);
}

}  // namespace troffer
