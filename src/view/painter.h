// Renders the pictures of a view on a thread of its own: coarse at once, then finer and finer.
//
// The first picture uses a few paths (render/preview.h) and always completes, so that users who
// keep moving see every step. Tracer, cells and radiosity of a scene are kept from view to view.
//
// Layers on the board: "whole" (all light), "albedo" and "error" (standard error of luminance) of
// first hits if the method provides them, "dimmer0" … (one dimmer alone), "dimmed" (all dimmers as
// set), and "second" (another method). A layer's `view` tells its camera.
// While a dimmer is set, "dimmed" is the first picture after every move and every change of
// settings. The dimmers' layers then come before "whole", and the page adds them up once they are
// complete. Otherwise coarse layers by dimmers follow when "whole" is done.
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

// The view to render.
struct ViewRequest {
  std::shared_ptr<Lighting> lighting;
  Camera camera;
  ImageSize size{};
};
// Settings that keep the layers of a view.
struct ViewExtras {
  DimmerSettings settings;       // one factor per dimmer; empty: no dimmer is set
  std::optional<Method> second;  // another method to show next to the first
  bool operator==(const ViewExtras&) const = default;
  bool is_dimmed() const { return settings.size() > 1; }
};

// Progress, for the page's status line.
struct PaintingState {
  uint64_t view = 0;
  std::string stage;  // for people
  double progress = 0, seconds = 0;
  double seconds_to_first = 0;  // from the request to its first picture; 0: not there yet
  std::string failure;          // why there is no picture; empty: no failure
};

// Renders views. Thirteen members: its environment, orders from other threads, and work in
// progress. Public functions are thread-safe.
class Painter {
 public:
  // options: method, error, seed, threads. The board must outlive the painter.
  Painter(LayerBoard& board, const RenderOptions& options);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  // Starts a new view and returns its number.
  uint64_t show(const ViewRequest& request);
  void set_extras(const ViewExtras& extras);
  ViewRequest request() const;
  ViewExtras extras() const;
  PaintingState state() const;

 private:
  using Clock = std::chrono::steady_clock;
  // Preparation kept for a scene under one light.
  struct Kept {
    std::shared_ptr<const PreparedScene> scene;
    std::shared_ptr<const PreparedScene> traced;  // scene whose tracer the cells refer to
    CellStore cells;
    std::unique_ptr<Preparation> preparation;
  };
  // A layer of the current view.
  struct Work {
    std::string layer;
    int dimmer = -1;                              // the dimmer that lights it alone; -1: all light
    std::shared_ptr<const PreparedScene> dimmed;  // scene of the layer "dimmed"
    Method method = Method::certified;
    std::vector<Pass> passes;
    size_t next = 0;  // index of the next pass
    bool has_first = false;
    PassMean mean;
  };
  // Orders of other threads, and their state.
  struct Orders {
    ViewRequest request;
    ViewExtras extras;
    uint64_t view = 0, number = 0;  // `number` grows with every order, `view` with every view
    Clock::time_point asked;        // time of the view's request
    bool is_ending = false, may_cancel = false;
    bool has_dimmers = false;  // every dimmer has a layer of this view, for the page to add up
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
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Orders orders_;  // guarded by the mutex
  StopFlag cancel_ = false;
  std::vector<Work> works_;  // steps of the current view
  double blocks_ = PreviewPace().first_blocks;
  uint64_t view_ = 0;
  Clock::time_point begun_;
  std::shared_ptr<Lighting> lighting_;
  std::map<std::string, Kept> kept_;
  std::thread thread_;  // last member: its thread uses all others
};

}  // namespace troffer
