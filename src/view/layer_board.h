// Holds the newest picture of each layer, between the threads that render and those that show them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "image/image.h"

namespace troffer {

// A picture of one layer.
struct ViewLayer {
  Image image;
  uint64_t version = 0;  // grows with every picture on the board
  uint64_t view = 0;     // number of the view that it belongs to
  double error = 0;      // relative standard error of a pixel; 0: unknown
};

// Layers by name. Thread-safe.
class LayerBoard {
 public:
  void put(const std::string& name, Image image, uint64_t view, double error);
  std::shared_ptr<const ViewLayer> get(const std::string& name) const;  // null: no such layer
  // Returns all layers without their pixels.
  std::map<std::string, ViewLayer> list() const;
  void remove(const std::string& name);

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ViewLayer>> layers_;
  uint64_t version_ = 0;
};

}  // namespace troffer
