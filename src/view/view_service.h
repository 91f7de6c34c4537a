// What the page asks for, and the answers: the names behind the token (docs/view.md).
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "view/http_server.h"
#include "view/layer_board.h"
#include "view/measuring_queue.h"
#include "view/painter.h"

namespace troffer {

struct ViewSettings {
  Camera camera;              // at the start
  int width = 0, height = 0;  // of the picture; 0: by the camera, of moderate size
  Vec3 up{0, 1, 0};
  RenderOptions options;  // method, indirect light, error, seed, threads
  std::string file;       // of the scene
  std::string notice;     // what whoever looks must know; empty: nothing
  // The time of day that light from the sky is of, "2026-06-21T12:00+02:00"; empty: none is known.
  std::string time;
  // The scene at another time; may be null. May throw UsageError and InputError.
  std::function<Scene(const std::string& time)> relit;
};

class ViewService {
 public:
  // All must outlive this. Shows the first camera at once.
  ViewService(std::shared_ptr<Lighting> lighting, ViewSettings settings, LayerBoard& board,
              Painter& painter, MeasuringQueue& desk);

  // UsageError for what makes no sense. From one thread at a time.
  HttpResponse answer(const HttpRequest& request);
  // The page has asked for the end.
  bool is_closed() const { return is_closed_; }

 private:
  HttpResponse get(const HttpRequest& request);
  HttpResponse post(const HttpRequest& request);
  HttpResponse state() const;
  HttpResponse layer(const HttpRequest& request) const;
  HttpResponse picture(const HttpRequest& request) const;
  HttpResponse measured(const HttpRequest& request, bool is_csv) const;
  void move(const std::string& body);
  void change_extras(const std::string& body);
  void change_time(const std::string& body);
  HttpResponse pick(const std::string& body);
  HttpResponse grid(const std::string& body);
  HttpResponse measure_again(const std::string& body);
  MeasuringPoint point_at(double x, double y, std::string* name) const;
  HttpResponse begin_measuring(const MeasuringTask& task, const nlohmann::json& about);
  void show(const Camera& camera, const ImageSize& size);

  std::shared_ptr<Lighting> lighting_;
  ViewSettings settings_;
  LayerBoard& board_;
  Painter& painter_;
  MeasuringQueue& desk_;
  std::atomic<bool> is_closed_ = false;
};

// Width and height for a camera where none are asked for: its aspect ratio, and few enough pixels
// that a first picture is there soon.
ImageSize moderate_size(const Camera& camera);

}  // namespace troffer
