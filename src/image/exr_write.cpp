#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cstring>

#include "base/error.h"
#include "image/encode.h"
#include "image/exr_header.h"

namespace troffer {

namespace {

class MemoryOStream : public Imf::OStream {
 public:
  explicit MemoryOStream(std::vector<uint8_t>& bytes) : Imf::OStream("memory"), bytes_(bytes) {}
  void write(const char data[], int n) override {
    const auto size = size_t(n);
    if (bytes_.size() < at_ + size) bytes_.resize(at_ + size);
    if (n > 0) std::memcpy(bytes_.data() + at_, data, size);
    at_ += size;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t at) override { at_ = at; }

 private:
  std::vector<uint8_t>& bytes_;
  uint64_t at_ = 0;
};

Imf::Header make_header(const Image& image, const ImageWindow& window) {
  const Imath::Box2i data({window.x, window.y},
                          {window.x + image.width - 1, window.y + image.height - 1});
  const Imath::Box2i whole({0, 0}, {window.full_width - 1, window.full_height - 1});
  Imf::Header header(window.full_width > 0 ? whole : data, data);
  header.compression() = Imf::ZIP_COMPRESSION;
  return header;
}

}  // namespace

std::vector<uint8_t> encode_exr(std::span<const Layer> layers, const ImageWindow& window,
                                const std::string& note) {
  Imf::Header header = make_header(layers[0].image, window);
  if (!note.empty()) header.insert(note_attribute, Imf::StringAttribute(note));
  Imf::FrameBuffer frame;
  for (const Layer& layer : layers)
    for (size_t c = 0; c < layer.channels.size(); ++c) {
      const std::string name =
          layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      TROFFER_CHECK(header.channels().findChannel(name) == nullptr);
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      const float* first = &layer.image.pixels[0].r + c;
      frame.insert(name, Imf::Slice::Make(Imf::FLOAT, first, header.dataWindow(), sizeof(Rgb),
                                          sizeof(Rgb) * size_t(layer.image.width)));
    }
  std::vector<uint8_t> bytes;
  try {
    MemoryOStream stream(bytes);
    Imf::OutputFile file(stream, header, 0);  // without threads
    file.setFrameBuffer(frame);
    file.writePixels(layers[0].image.height);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw EnvironmentError(std::string("cannot encode EXR: ") + e.what());
  }
  return bytes;
}

}  // namespace troffer
