#include <Iex.h>
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include <array>
#include <cstring>

#include "image/decode.h"
#include "image/exr_header.h"
#include "image/exr_stream.h"

namespace troffer {

namespace {

// Channels that form a picture: one or three colours, optionally alpha.
struct Selection {
  std::vector<std::string> names;
  bool is_luminance_chroma = false;
};

// Selects the colours of the layer with this prefix ("" or "name."). Returns false if it has none.
bool select_rgb(const Imf::ChannelList& channels, const std::string& prefix, Selection& out) {
  bool has_any = false;
  for (const char* c : {"R", "G", "B"}) has_any |= channels.findChannel(prefix + c) != nullptr;
  if (!has_any) return false;
  out.names = {prefix + "R", prefix + "G", prefix + "B"};
  if (channels.findChannel(prefix + "A") != nullptr) out.names.push_back(prefix + "A");
  return true;
}

Selection select_channels(const Imf::ChannelList& channels) {
  Selection out;
  if (select_rgb(channels, "", out)) return out;
  if (channels.findChannel("Y") != nullptr) {
    out.names = {"Y"};
    if (channels.findChannel("A") != nullptr) out.names.push_back("A");
    out.is_luminance_chroma =
        channels.findChannel("RY") != nullptr && channels.findChannel("BY") != nullptr;
    return out;
  }
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string name = it.name();
    const size_t dot = name.rfind('.');
    if (dot != name.npos && select_rgb(channels, name.substr(0, dot + 1), out)) return out;
  }
  if (channels.begin() != channels.end()) out.names = {channels.begin().name()};
  return out;
}

// Reads luminance and subsampled chroma, which OpenEXR converts in half precision.
void read_luminance_chroma(const EncodedImage& encoded, Raster& raster) {
  MemoryIStream stream(encoded);
  Imf::RgbaInputFile file(stream, 0);
  const Imath::Box2i window = file.dataWindow();
  const auto width = size_t(raster.width), height = size_t(raster.height);
  std::vector<Imf::Rgba> row(width);
  raster.channels = 3;
  raster.texels_float.resize(width * height * 3);
  // OpenEXR expects the address of pixel (0, 0), which may lie outside the row; integer arithmetic
  // avoids invalid pointers. A line stride of 0 puts every line into `row`.
  const auto first = reinterpret_cast<intptr_t>(row.data());
  auto* base =
      reinterpret_cast<Imf::Rgba*>(first - int64_t(window.min.x) * int64_t(sizeof(Imf::Rgba)));
  for (size_t y = 0; y < height; ++y) {
    const int line = window.min.y + int(y);
    file.setFrameBuffer(base, 1, 0);
    file.readPixels(line);
    float* out = raster.texels_float.data() + y * width * 3;
    for (const Imf::Rgba& p : row)
      for (const float v : {float(p.r), float(p.g), float(p.b)}) *out++ = v;
  }
}

void read_channels(Imf::InputFile& file, const Selection& selection, const EncodedImage& encoded,
                   Raster& raster) {
  const Imf::ChannelList& channels = file.header().channels();
  const Imath::Box2i window = file.header().dataWindow();
  const size_t n = selection.names.size();
  raster.channels = int(n);
  raster.texels_float.resize(size_t(raster.width) * size_t(raster.height) * n);
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < n; ++c) {
    const Imf::Channel* channel = channels.findChannel(selection.names[c]);
    if (channel != nullptr && (channel->xSampling != 1 || channel->ySampling != 1))
      encoded.fail("EXR with subsampled channel " + selection.names[c] + " is not supported");
    frame.insert(selection.names[c],
                 Imf::Slice::Make(Imf::FLOAT, raster.texels_float.data() + c, window,
                                  n * sizeof(float), n * sizeof(float) * size_t(raster.width)));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
}

// Returns the primaries if the header has valid ones that differ from Rec. 709.
std::optional<Primaries> primaries_of(const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return std::nullopt;
  const Imf::Chromaticities& c = Imf::chromaticities(header);
  const auto at = [](const Imath::V2f& v) { return Chromaticity{double(v.x), double(v.y)}; };
  const Primaries primaries{{at(c.red), at(c.green), at(c.blue)}, at(c.white)};
  const Affine matrix = srgb_from(primaries, true);
  for (const Vec3d& column : matrix.columns)
    if (!(length(column) < 1e3)) return std::nullopt;
  return are_srgb(primaries) ? std::nullopt : std::optional(primaries);
}

}  // namespace

bool is_exr(std::span<const uint8_t> bytes) {
  constexpr std::array<uint8_t, 4> magic{0x76, 0x2f, 0x31, 0x01};
  return bytes.size() >= 4 && std::memcmp(bytes.data(), magic.data(), 4) == 0;
}

Raster decode_exr(const EncodedImage& encoded) {
  check_exr_header(encoded);
  try {
    MemoryIStream stream(encoded);
    Imf::InputFile file(stream, 0);  // without threads
    const Imath::Box2i window = file.header().dataWindow();
    Raster raster;
    raster.width = window.max.x - window.min.x + 1;
    raster.height = window.max.y - window.min.y + 1;
    const Selection selection = select_channels(file.header().channels());
    if (selection.names.empty()) encoded.fail("EXR without channels");
    if (selection.is_luminance_chroma)
      read_luminance_chroma(encoded, raster);
    else
      read_channels(file, selection, encoded, raster);
    if (raster.channels >= 3) raster.primaries = primaries_of(file.header());
    return raster;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    encoded.fail(std::string("broken EXR: ") + e.what());
  }
}

}  // namespace troffer
