// OpenEXR input stream over a file in memory. The EXR readers use it, so that files are read and
// checked in one place. Throws OpenEXR's exception at the end of the data.
#pragma once

#include <Iex.h>
#include <ImfIO.h>

#include <cstring>

#include "image/decode.h"

namespace troffer {

class MemoryIStream : public Imf::IStream {
 public:
  explicit MemoryIStream(const EncodedImage& encoded)
      : Imf::IStream(encoded.name.c_str()), bytes_(encoded.bytes) {}
  bool read(char out[], int n) override {
    if (n < 0 || at_ > bytes_.size() || size_t(n) > bytes_.size() - at_)
      throw IEX_NAMESPACE::InputExc("truncated file");
    if (n > 0) std::memcpy(out, bytes_.data() + at_, size_t(n));
    at_ += uint64_t(n);
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t at) override { at_ = at; }

 private:
  std::span<const uint8_t> bytes_;
  uint64_t at_ = 0;
};

}  // namespace troffer
