// Answers the page's requests: the paths after the token (docs/reference/view.md). HttpServer calls
// answer().
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
#include "view/year_answers.h"

namespace troffer {

// Initial state of the page.
struct ViewSettings {
  Camera camera;              // first camera
  int width = 0, height = 0;  // size of the picture; 0: moderate_size() of the camera
  Vec3 up{0, 1, 0};
  RenderOptions options;  // method, indirect light, error, seed, threads
  std::string file;       // scene file
  std::string notice;     // a notice for the user; empty: none
  // Time of the daylight, "2026-06-21T12:00+02:00"; empty: unknown.
  std::string time;
  // Returns the scene at another time; may be null. May throw UsageError and InputError.
  std::function<Scene(const std::string& time)> relit;
  std::shared_ptr<StoredHours> year;  // a year of daylight of this scene; may be null
};

// Connects the page with painter, board and measuring queue.
class ViewService {
 public:
  // All arguments must outlive the service. Shows the first camera at once.
  ViewService(std::shared_ptr<Lighting> lighting, ViewSettings settings, LayerBoard& board,
              Painter& painter, MeasuringQueue& desk);

  // Answers a request. Throws UsageError for invalid ones. Call from one thread at a time.
  HttpResponse answer(const HttpRequest& request);
  // Returns notes on a year that may be of another scene.
  std::vector<std::string> notes() const;
  // True if the page has asked to close.
  bool is_closed() const { return is_closed_; }

 private:
  HttpResponse get(const HttpRequest& request);
  HttpResponse post(const HttpRequest& request);
  HttpResponse state() const;
  HttpResponse sensors_in_sight() const;
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
  std::unique_ptr<YearAnswers> year_;  // null: no year
  std::atomic<bool> is_closed_ = false;
};

// Returns the picture's size for a camera if none is asked for: its aspect ratio, and few enough
// pixels for a quick first picture.
ImageSize moderate_size(const Camera& camera);

}  // namespace troffer
