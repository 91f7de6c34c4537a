#include "view/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "render/tile.h"

namespace troffer {

namespace {

constexpr int fewest_blocks = 16;  // blocks of a first picture along its longer side, at least

// Resizes an image by nearest pixels.
Image resized(const Image& from, int width, int height) {
  Image to(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      to.at(x, y) =
          from.at(int(int64_t(x) * from.width / width), int(int64_t(y) * from.height / height));
  return to;
}

int shrunk(int side, int by) {
  return std::max(1, (side + by - 1) / by);
}

const Image* layer_named(const RenderResult& r, const char* name) {
  for (const Layer& l : r.layers)
    if (l.name == name) return &l.image;
  return nullptr;
}

}  // namespace

Painter::Painter(LayerBoard& board, const RenderOptions& options)
    : board_(board), options_(options), thread_([this] { run(); }) {}

Painter::~Painter() {
  {
    const std::lock_guard lock(mutex_);
    orders_.is_ending = true;
    cancel_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

uint64_t Painter::show(const ViewRequest& request) {
  const std::lock_guard lock(mutex_);
  orders_.request = request;
  orders_.asked = Clock::now();
  // The first picture of the current view is nearly done, and is better than none: let it finish.
  if (orders_.may_cancel) cancel_ = true;
  orders_.has_dimmers = false;
  ++orders_.number;
  changed_.notify_all();
  return ++orders_.view;
}

void Painter::set_extras(const ViewExtras& extras) {
  const std::lock_guard lock(mutex_);
  if (orders_.extras == extras) return;
  const bool is_sum = orders_.has_dimmers && orders_.extras.is_dimmed() && extras.is_dimmed() &&
                      orders_.extras.second == extras.second;
  orders_.extras = extras;
  if (is_sum) return;  // only the settings changed, and the page has all layers to add up
  if (orders_.may_cancel) cancel_ = true;
  ++orders_.number;
  changed_.notify_all();
}

ViewRequest Painter::request() const {
  const std::lock_guard lock(mutex_);
  return orders_.request;
}

ViewExtras Painter::extras() const {
  const std::lock_guard lock(mutex_);
  return orders_.extras;
}

PaintingState Painter::state() const {
  const std::lock_guard lock(mutex_);
  return orders_.state;
}

void Painter::run() {
  for (uint64_t done = 0;;) {
    Orders orders;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return orders_.is_ending || orders_.number != done; });
      if (orders_.is_ending) return;
      done = orders_.number;
      cancel_ = false;
      orders_.may_cancel = false;
      if (orders_.state.view != orders_.view) orders_.state = PaintingState();
      orders_.state.view = orders_.view;
      orders = orders_;
    }
    std::string failure;
    try {
      if (orders.request.lighting) paint(orders);
    } catch (const std::exception& e) {  // out of memory, or an extreme camera
      failure = e.what();
    }
    const std::lock_guard lock(mutex_);
    orders_.state.failure = failure;
    orders_.may_cancel = true;
  }
}

void Painter::paint(const Orders& orders) {
  if (view_ != orders.view) works_.clear();
  view_ = orders.view;
  begun_ = orders.asked;
  lighting_ = orders.request.lighting;
  tell("Rendering a first picture", 0);
  sight(orders);
  add_works(orders);
  const bool is_dimmed = orders.extras.is_dimmed();
  const size_t dimmers = orders.request.lighting->dimmers().size();
  for (Work& w : works_) {
    const bool is_wanted = w.dimmer >= 0 || w.layer == "dimmed" ? is_dimmed
                           : w.layer == "whole"                 ? !is_dimmed
                                                                : false;
    if (is_wanted && !w.has_first && w.next == 0) look(orders, w, w.dimmer >= 0 ? dimmers : 1);
  }
  {
    const std::lock_guard lock(mutex_);
    orders_.may_cancel = true;
    if (is_dimmed && !cancel_ && orders_.view == orders.view) orders_.has_dimmers = true;
    if (orders_.number != orders.number) cancel_ = true;
  }
  go_through(orders);
  if (!cancel_) tell("done", 1);
}

// Adds the works that the orders ask for and removes those that are not wanted any more, in the
// order of their first pictures.
void Painter::add_works(const Orders& orders) {
  Lighting& lighting = *orders.request.lighting;
  const auto add = [&](const std::string& layer, int dimmer, const Method& method) {
    const auto is_same = [&](const Work& w) { return w.layer == layer && w.method == method; };
    if (std::any_of(works_.begin(), works_.end(), is_same)) return;
    std::erase_if(works_, [&](const Work& w) { return w.layer == layer; });
    Work work;
    work.layer = layer;
    work.dimmer = dimmer;
    work.method = method;
    work.passes = passes_to(method, options_.error);
    works_.push_back(std::move(work));
  };
  std::erase_if(works_, [](const Work& w) { return w.layer == "dimmed"; });
  if (orders.extras.is_dimmed()) {
    Work dimmed;
    dimmed.layer = "dimmed";
    dimmed.method = options_.method;
    dimmed.dimmed = lighting.dimmed(orders.extras.settings);
    works_.insert(works_.begin(), std::move(dimmed));
  }
  add("whole", -1, options_.method);
  const int count = int(lighting.dimmers().size());
  for (int i = 0; count > 1 && i < count; ++i)
    add("dimmer" + std::to_string(i), i, options_.method);
  if (orders.extras.second) {
    add("second", -1, *orders.extras.second);
  } else {
    std::erase_if(works_, [](const Work& w) { return w.layer == "second"; });
    board_.remove("second");
  }
}

// Shows a first sight of the scene while its tracer is built.
void Painter::sight(const Orders& orders) {
  const ViewRequest& r = orders.request;
  r.lighting->before_preparing([&](const Scene& scene) {
    Preview preview([&](const Image& image) { board_.put("whole", image, orders.view, 0); });
    RenderOptions o = options_;
    o.width = r.size.width;
    o.height = r.size.height;
    preview.sight(scene, r.camera, o, false);
  });
}

RenderOptions Painter::options_of(const ViewRequest& r, const Work& work, const Pass& pass) const {
  RenderOptions o = options_;
  o.method = work.method;
  o.width = shrunk(r.size.width, pass.shrink);
  o.height = shrunk(r.size.height, pass.shrink);
  o.error = pass.error;
  o.spp = pass.spp;
  o.seed = hash_of(options_.seed, uint64_t(work.next), uint64_t(pass.shrink));
  o.aovs = {Aov::error};
  if (work.layer == "whole") o.aovs.push_back(Aov::albedo);
  return o;
}

// Renders the first picture, by paths. It gets the share 1/of of the time for first pictures.
void Painter::look(const Orders& orders, Work& work, size_t of) {
  if (cancel_) return;
  const ViewRequest& r = orders.request;
  PreviewPace pace;
  pace.look_seconds /= double(of);
  pace.first_blocks = std::max(fewest_blocks, int(blocks_ / std::sqrt(double(of))));
  const Clock::time_point start = Clock::now();
  Preview preview(
      [&](const Image& image) {
        if (!work.has_first && of == 1) learn_pace(Clock::now() - start);
        work.has_first = true;
        put(orders, work, image, 0);
      },
      pace);
  const std::shared_ptr<const PreparedScene> prepared = scene_of(work);
  const PreparedScene& scene = *prepared;
  const RenderOptions options = options_of(r, work, Pass());
  check_options(scene, r.camera, options);
  preview.look(scene, r.camera, options, cancel_);
}

// Adapts the resolution of the next first picture to the time that this one took. Twice as many
// blocks along a side cost four times the work.
void Painter::learn_pace(std::chrono::duration<double> taken) {
  constexpr double aim = 0.08;
  const double most = PreviewPace().first_blocks;
  blocks_ = std::clamp(blocks_ * std::sqrt(aim / std::max(taken.count(), 1e-3)),
                       double(fewest_blocks), most);
}

// Runs the passes: layers that are shown come first, and the coarse passes of each layer.
void Painter::go_through(const Orders& orders) {
  const bool wants_dimmers = orders.extras.is_dimmed();
  constexpr size_t coarse_passes = 2;
  const auto rank = [&](const Work& w) {
    const int lateness = w.dimmer >= 0 ? (wants_dimmers ? 0 : 3) : w.layer == "second" ? 2 : 1;
    return std::pair(lateness, w.next);
  };
  const auto last = [&](const Work& w) {
    return w.dimmer >= 0 && !wants_dimmers ? std::min(coarse_passes, w.passes.size())
                                           : w.passes.size();
  };
  for (;;) {
    Work* next = nullptr;
    for (Work& w : works_)
      if (w.next < last(w) && (next == nullptr || rank(w) < rank(*next))) next = &w;
    if (next == nullptr || cancel_) return;
    pass(orders, *next);
  }
}

void Painter::pass(const Orders& orders, Work& work) {
  const ViewRequest& r = orders.request;
  const Pass& pass = work.passes[work.next];
  const std::string stage = stage_of(work);
  tell(stage, 0);
  Kept& k = kept(work);
  if (!k.preparation)
    k.preparation = prepare(*k.scene, work.method, options_.kj92, options_.indirect, std::nullopt,
                            options_.threads, nullptr, cancel_);
  RenderOptions o = options_of(r, work, pass);
  o.preparation = k.preparation.get();
  CellStore cells = k.cells;  // a stopped pass leaves no cells
  o.cells = &cells;
  PreviewPace pace;
  pace.interval = 0.5;
  Preview preview([&](const Image& image) { put(orders, work, image, 0); }, pace);
  // Tiles of the first picture of full size are shown as they come. Of a later pass only the mean
  // with earlier passes improves the picture.
  const bool is_shown = work.next > 0 && work.passes[work.next - 1].shrink > pass.shrink;
  if (is_shown) {
    preview.go_on_from(resized(work.mean.mean(), o.width, o.height), {0, 0, o.width, o.height});
    o.preview = &preview;
  }
  const RenderResult result = render(
      *k.scene, r.camera, o, [&](double f) { tell(stage, f); }, cancel_);
  if (!result.is_complete || cancel_) return;
  ++work.next;
  k.cells = std::move(cells);
  if (!k.traced && k.cells.map) k.traced = k.scene;
  const Image* error = layer_named(result, "error");
  work.mean.add(result.layers[0].image, error != nullptr ? *error : Image(), pass.weight);
  put(orders, work, work.mean.mean(), work.mean.relative_error());
  if (work.layer != "whole") return;
  board_.put("error", work.mean.error(), orders.view, 0);
  if (const Image* albedo = layer_named(result, "albedo"))
    board_.put("albedo", *albedo, orders.view, 0);
}

std::shared_ptr<const PreparedScene> Painter::scene_of(const Work& work) {
  if (work.dimmed) return work.dimmed;
  return work.dimmer >= 0 ? lighting_->dimmer(size_t(work.dimmer)) : lighting_->whole();
}

// Returns what is kept for a work. If only the light changed, cells and rows stay, and their direct
// light is computed again.
Painter::Kept& Painter::kept(const Work& work) {
  const std::shared_ptr<const PreparedScene> scene = scene_of(work);
  const std::string name =
      work.layer == "second" ? "second " + std::string(work.method.row().name) : work.layer;
  Kept& k = kept_[name];
  if (k.scene == scene) return k;
  const Kept& from = k.scene != nullptr ? k : kept_["whole"];
  if (from.cells.map) {
    CellStore cells = from.cells;
    cells.direct.clear();
    cells.direct_half_difference.clear();
    cells.direct_error = std::numeric_limits<double>::infinity();
    k.traced = from.traced;
    k.cells = std::move(cells);
  }
  k.scene = scene;
  k.preparation.reset();
  return k;
}

void Painter::put(const Orders& orders, const Work& work, const Image& image, double error) {
  board_.put(work.layer, image, orders.view, error);
  const bool is_whole = work.layer == "whole";
  if (is_whole || work.layer == "dimmed") {
    const std::lock_guard lock(mutex_);
    PaintingState& s = orders_.state;
    if (s.seconds_to_first == 0)
      s.seconds_to_first = std::chrono::duration<double>(Clock::now() - begun_).count();
    orders_.may_cancel = true;
    if (orders_.number != orders.number) cancel_ = true;
  }
}

// Describes the work for the page's status line.
std::string Painter::stage_of(const Work& work) const {
  const std::string pass = fmt::format("step {} of {}", work.next + 1, work.passes.size());
  if (work.dimmer >= 0)
    return fmt::format("Rendering {} alone, {}", lighting_->dimmers()[size_t(work.dimmer)].name,
                       pass);
  if (work.layer == "second")
    return fmt::format("Rendering with {}, {}", work.method.row().name, pass);
  return "Refining, " + pass;
}

void Painter::tell(const std::string& stage, double progress) {
  const std::lock_guard lock(mutex_);
  PaintingState& s = orders_.state;
  s.stage = stage;
  s.progress = progress;
  s.seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
}

}  // namespace troffer
