// Where pictures are put as they are made, and taken from by whoever shows them; by any thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "image/image.h"

namespace troffer {

struct ViewLayer {
  Image image;
  uint64_t version = 0;  // grows with every picture put up
  uint64_t view = 0;     // of which request
  double error = 0;      // standard error of a pixel, relative; 0: not known yet
};

class LayerBoard {
 public:
  void put(const std::string& name, Image image, uint64_t view, double error);
  std::shared_ptr<const ViewLayer> get(const std::string& name) const;  // null: there is none
  // By name, without the pixels.
  std::map<std::string, ViewLayer> list() const;
  void remove(const std::string& name);

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ViewLayer>> layers_;
  uint64_t version_ = 0;
};

}  // namespace troffer
