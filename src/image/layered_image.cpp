#include "image/layered_image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <map>
#include <new>

#include "image/exr_header.h"
#include "image/exr_stream.h"
#include "image/read_image.h"

namespace troffer {

namespace {

// Sorts R, G, B in that order, other channels by name.
bool is_before(const std::string& a, const std::string& b) {
  const std::string order = "RGB";
  const size_t i = order.find(a), j = order.find(b);
  return i != order.npos && j != order.npos ? i < j : a < b;
}

// Returns channel names by layer.
std::map<std::string, std::vector<std::string>> channels_of(const Imf::ChannelList& all,
                                                            const EncodedImage& encoded) {
  std::map<std::string, std::vector<std::string>> layers;
  for (auto c = all.begin(); c != all.end(); ++c) {
    const std::string name = c.name();
    if (c.channel().type != Imf::FLOAT || c.channel().xSampling != 1 || c.channel().ySampling != 1)
      encoded.fail("channel " + name + " is not of 32-bit floats, one a pixel");
    const size_t dot = name.rfind('.');
    layers[dot == name.npos ? "" : name.substr(0, dot)].push_back(
        dot == name.npos ? name : name.substr(dot + 1));
  }
  for (auto& [name, channels] : layers) {
    std::sort(channels.begin(), channels.end(), is_before);
    if (channels.size() != 1 && channels.size() != 3)
      encoded.fail("layer '" + name + "' has " + std::to_string(channels.size()) + " channels");
  }
  if (layers.count("") == 0) encoded.fail("there is no picture, only layers");
  return layers;
}

LayeredImage read(const EncodedImage& encoded) {
  MemoryIStream stream(encoded);
  Imf::InputFile file(stream, 0);  // without threads
  const Imf::Header& header = file.header();
  const Imath::Box2i data = header.dataWindow(), whole = header.displayWindow();
  LayeredImage image;
  image.window = {data.min.x, data.min.y, 0, 0};
  if (whole.min == Imath::V2i(0, 0) && whole.max.x < (1 << 24) && whole.max.y < (1 << 24)) {
    image.window.full_width = whole.max.x + 1;
    image.window.full_height = whole.max.y + 1;
  }
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  const auto* note = header.findTypedAttribute<Imf::StringAttribute>(note_attribute);
  if (note != nullptr) image.note = note->value();
  const auto layers = channels_of(header.channels(), encoded);
  encoded.check_size(uint64_t(width) * layers.size(), uint64_t(height));
  for (const auto& [name, channels] : layers)
    image.layers.push_back({name, channels, Image(width, height)});
  Imf::FrameBuffer frame;
  for (Layer& layer : image.layers)
    for (size_t c = 0; c < layer.channels.size(); ++c)
      frame.insert(layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c],
                   Imf::Slice::Make(Imf::FLOAT, &layer.image.pixels[0].r + c, data, sizeof(Rgb),
                                    sizeof(Rgb) * size_t(width)));
  file.setFrameBuffer(frame);
  file.readPixels(data.min.y, data.max.y);
  return image;
}

}  // namespace

LayeredImage read_layers(const std::string& path, size_t max_pixels) {
  const std::vector<uint8_t> bytes = read_file_bytes(path);
  const EncodedImage encoded{bytes, path, max_pixels};
  if (!is_exr(bytes)) encoded.fail("not an OpenEXR picture");
  check_exr_header(encoded);
  try {
    return read(encoded);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    encoded.fail("not enough memory to decode this picture");
  } catch (const std::exception& e) {
    encoded.fail(std::string("broken EXR: ") + e.what());
  }
}

}  // namespace troffer
