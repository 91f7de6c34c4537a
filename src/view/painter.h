// Makes the pictures of a view, coarse at once and then finer and finer, on a thread of its own.
//
// The first one is by a few paths (render/preview.h) and is put up before anything else may
// interrupt the work, so that whoever moves on and on sees every step. What is prepared for the
// scene is kept from view to view: tracer, cells, radiosity.
//
// Layers that are put up: "whole", all light; "albedo" of what is seen first, and "error", the
// standard error of the luminance, once the method tells of them; "dimmer0" … by one dimmer alone,
// "dimmed" by all as they are set, and "second", by another method. Their names say what they are
// of; their `view` of which camera.
// While a dimmer is set, "dimmed" is the first picture after every move and every change of
// settings, and the dimmers' own layers come before "whole": once they are there, the page adds
// them up by itself. Otherwise coarse layers by dimmers are made once "whole" is done.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/camera.h"
#include "render/preview.h"
#include "render/render.h"
#include "view/dimmers.h"
#include "view/layer_board.h"
#include "view/passes.h"

namespace troffer {

struct ViewRequest {
  std::shared_ptr<Lighting> lighting;
  Camera camera;
  ImageSize size{};
};
// Requests that keep the layers of a view.
struct ViewExtras {
  DimmerSettings settings;       // one factor per dimmer; empty: no dimmer is set
  std::optional<Method> second;  // shown beside
  bool operator==(const ViewExtras&) const = default;
  bool is_dimmed() const { return settings.size() > 1; }
};

struct PaintingState {
  uint64_t view = 0;
  std::string stage;  // for people
  double progress = 0, seconds = 0;
  double seconds_to_first = 0;  // from the request to its first picture; 0: not there yet
  std::string failure;          // why there is none; empty: all is well
};

// Fourteen members: what it is made with, what other threads tell it, and what is under way.
class Painter {
 public:
  using Shown = std::function<void(const Image&)>;
  // options: method, error, seed, threads. The board must outlive this. shown: is called with every
  // picture of all light; may be null.
  Painter(LayerBoard& board, const RenderOptions& options, Shown shown);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  // What is to be shown from now on; returns the number of the view.
  uint64_t show(const ViewRequest& request);
  void set_extras(const ViewExtras& extras);
  ViewRequest request() const;
  ViewExtras extras() const;
  PaintingState state() const;

 private:
  using Clock = std::chrono::steady_clock;
  // What is kept of a scene by one light.
  struct Kept {
    std::shared_ptr<const PreparedScene> scene;
    std::shared_ptr<const PreparedScene> traced;  // cells hold on to its tracer
    CellStore cells;
    std::unique_ptr<Preparation> preparation;
  };
  // A layer of the view under way.
  struct Work {
    std::string layer;
    int dimmer = -1;                              // by its light alone; -1: all light
    std::shared_ptr<const PreparedScene> dimmed;  // "dimmed" alone has a scene of its own
    Method method = Method::certified;
    std::vector<Pass> passes;
    size_t next = 0;  // of these
    bool has_first = false;
    PassMean mean;
  };
  // What is to be done, and how far it is.
  struct Orders {
    ViewRequest request;
    ViewExtras extras;
    uint64_t view = 0, number = 0;  // the number grows with every order, the view with its request
    Clock::time_point asked;        // the view
    bool is_ending = false, may_cancel = false;
    bool has_dimmers = false;  // every dimmer has a layer of this view: the page can add them up
    PaintingState state;
  };

  void run();
  void paint(const Orders& orders);
  void add_works(const Orders& orders);
  void sight(const Orders& orders);
  void look(const Orders& orders, Work& work, size_t of);
  void learn_pace(std::chrono::duration<double> taken);
  void go_through(const Orders& orders);
  void pass(const Orders& orders, Work& work);
  std::shared_ptr<const PreparedScene> scene_of(const Work& work);
  Kept& kept(const Work& work);
  RenderOptions options_of(const ViewRequest& r, const Work& work, const Pass& pass) const;
  void put(const Orders& orders, const Work& work, const Image& image, double error);
  std::string stage_of(const Work& work) const;
  void tell(const std::string& stage, double progress);

  LayerBoard& board_;
  const RenderOptions options_;
  const Shown shown_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Orders orders_;  // by the mutex
  StopFlag cancel_ = false;
  std::vector<Work> works_;  // of this view
  double blocks_ = PreviewPace().first_blocks;
  uint64_t view_ = 0;
  Clock::time_point begun_;
  std::shared_ptr<Lighting> lighting_;
  std::map<std::string, Kept> kept_;
  std::thread thread_;  // last: it uses all the others
};

}  // namespace troffer
