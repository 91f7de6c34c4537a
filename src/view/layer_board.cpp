#include "view/layer_board.h"

#include <utility>

namespace troffer {

void LayerBoard::put(const std::string& name, Image image, uint64_t view, double error) {
  auto layer = std::make_shared<ViewLayer>(ViewLayer{std::move(image), 0, view, error});
  const std::lock_guard lock(mutex_);
  layer->version = ++version_;
  layers_[name] = std::move(layer);
}

std::shared_ptr<const ViewLayer> LayerBoard::get(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto at = layers_.find(name);
  return at == layers_.end() ? nullptr : at->second;
}

std::map<std::string, ViewLayer> LayerBoard::list() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, ViewLayer> all;
  for (const auto& [name, layer] : layers_) {
    ViewLayer& l = all[name];
    l.image.width = layer->image.width;
    l.image.height = layer->image.height;
    l.version = layer->version;
    l.view = layer->view;
    l.error = layer->error;
  }
  return all;
}

void LayerBoard::remove(const std::string& name) {
  const std::lock_guard lock(mutex_);
  layers_.erase(name);
}

}  // namespace troffer
