#include "render/rendering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/deadline.h"
#include "base/error.h"
#include "base/process_group.h"
#include "base/units.h"
#include "render/preview.h"

namespace troffer {

namespace {

// Number of parts of the further rays after which RenderOptions::error_limit is tested.
constexpr size_t looks = 32;

}  // namespace

Rendering::Rendering(const PreparedScene& scene, const ViewingCamera& camera,
                     const Integrator& integrator, const RenderOptions& options, TilePlan plan,
                     const ProgressCallback& progress, const StopFlag& stop)
    : camera_(camera),
      options_(options),
      plan_(std::move(plan)),
      film_(plan_.region, options.aovs, scene.scene.origin),
      further_(scene, camera_, integrator, options, plan_),
      tracer_(camera_, integrator, options, further_, film_, stop),
      work_(size_t(thread_count(options.threads))),
      book_(plan_.tiles.size(), work_.size(), options.checkpoint != nullptr),
      archive_(plan_, film_, further_, book_),
      report_(progress),
      stop_(stop) {
  film_.set_evenness(integrator.sampling().evenness);
  if (further_.has_surrogates()) film_.expect_surrogates();
  // Footprints follow the number of rays that a pixel may come to. A footprint that extends beyond
  // a narrow surface adds an error that further rays do not reduce.
  const int usual = most_viewing_rays(options).usual;
  for (TileWork& w : work_) w.rays.cone = camera.cone(std::max(options.spp, usual));
  progress_.gaps = size_t(plan_.window.width()) * size_t(plan_.window.height());
  if (options.checkpoint != nullptr && !options.checkpoint->chunks().empty()) restore();
}

void Rendering::set_seconds_per_gap(double seconds_per_pixel) {
  progress_.seconds_per_gap = seconds_per_pixel;
  if (options_.deadline != nullptr)
    options_.deadline->keep_back(double(progress_.gaps) * seconds_per_pixel);
}

RenderEnd Rendering::run() {
  const bool uses_typical_luminance = options_.method.row().uses_typical_luminance;
  const auto typical = uses_typical_luminance ? float(typical_luminance()) : 0;
  for (TileWork& w : work_) {
    w.rays.request.is_picture = typical > 0;
    w.rays.request.typical_luminance = typical;
  }
  agree_on_limits();
  RenderEnd end = first_pass();
  if (further_.is_refined() && end == RenderEnd::complete) end = refine();
  if (options_.checkpoint != nullptr) archive_.save(*options_.checkpoint);
  return end;
}

RenderEnd Rendering::first_pass() {
  const TileSteps& all = further_.steps();
  const uint32_t at_a_time = progress_.is_stepwise ? 1 : all.first;
  for (uint32_t pass = 0; pass < all.first; pass += at_a_time) {
    step({pass, pass + at_a_time}, all_tiles(),
         [&](uint32_t n, const PixelRect& tile, TileWork& w) {
           const int first = int(n) * samples_per_pass;
           tracer_.first_pass(
               tile, uint32_t(std::min(samples_per_pass, further_.first_spp() - first)), w);
           return true;
         });
    if (progress_.was_stopped) return RenderEnd::stopped;
    if (pass + at_a_time < all.all() && is_good_enough(pass + at_a_time - 1, all_tiles()))
      return RenderEnd::good_enough;
  }
  return RenderEnd::complete;
}

// Traces the further rays that the first pass calls for.
RenderEnd Rendering::refine() {
  const bool is_same_in_crops = options_.method.row().is_same_in_crops;
  if (leads())
    further_.decide(film_, is_same_in_crops ? typical_luminance() : mean_luminance(plan_.asked));
  else
    further_.wait_for_leader();
  further_.begin();
  return further_.are_at_once() ? refine_by_tiles() : refine_by_passes();
}

RenderEnd Rendering::refine_by_passes() {
  if (options_.group != nullptr) share_records();
  const TileSteps& all = further_.steps();
  const uint32_t at_a_time = progress_.is_stepwise ? 1 : all.further;
  for (uint32_t pass = 0; pass < all.further; pass += at_a_time) {
    const uint32_t begin = all.first + pass, end = begin + at_a_time;
    step({begin, end}, all_tiles(), [&](uint32_t number, const PixelRect& tile, TileWork& w) {
      const int first = further_.first_spp() + int(number - all.first) * samples_per_pass;
      tracer_.further_pass(tile, first, w);
      return true;
    });
    if (progress_.was_stopped) return RenderEnd::stopped;
    if (pass + at_a_time < all.further && is_good_enough(end - 1, all_tiles()))
      return RenderEnd::good_enough;
  }
  return RenderEnd::complete;
}

// Traces all further rays of a tile at once: a few pixels may get many.
RenderEnd Rendering::refine_by_tiles() {
  const TileSteps& all = further_.steps();
  const uint32_t further = all.first + all.surrogates;
  const auto act = [&](uint32_t number, const PixelRect& tile, TileWork& w) {
    if (number >= further) return tracer_.further_rays(tile, w);
    tracer_.surrogates(tile, w);
    return true;
  };
  if (!progress_.is_stepwise) {
    // Start the longest tiles first.
    step({all.first, all.all()}, leads() ? further_.noisiest_first() : all_tiles(), act);
    return progress_.was_stopped ? RenderEnd::stopped : RenderEnd::complete;
  }
  if (all.surrogates > 0) step({all.first, further}, all_tiles(), act);
  Tiles left = is_limited() && leads() ? further_.noisiest_first() : all_tiles();
  const size_t parts = options_.error_limit > 0 ? std::min(looks, left.size()) : 1;
  const size_t in_all = left.size();
  for (size_t part = 0; part < parts; ++part) {
    if (progress_.was_stopped) return RenderEnd::stopped;
    if (is_good_enough(further - 1, left)) return RenderEnd::good_enough;
    const auto end = std::ptrdiff_t(in_all * (part + 1) / parts - (in_all - left.size()));
    step({further, further + 1}, Tiles(left.begin(), left.begin() + end), act);
    left.erase(left.begin(), left.begin() + end);
  }
  return progress_.was_stopped ? RenderEnd::stopped : RenderEnd::complete;
}

std::vector<Layer> Rendering::layers() const {
  std::vector<Layer> layers = film_.layers();
  for (Layer& l : layers) l.image = part_of(l.image, plan_.region, plan_.window);
  return layers;
}

ViewingErrors Rendering::viewing_errors() const {
  const PixelRect& w = plan_.window;
  ViewingErrors e;
  const double mean = mean_luminance(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const PixelEstimate p = film_.estimate(x, y);
      e.relative_rms += sqr(p.standard_error);
      constexpr double percent = 0.01;
      const double allowed = percent * std::max(p.luminance, mean);
      e.share_above += p.standard_error > allowed ? 1 : 0;
    }
  const double pixels = double(w.width()) * w.height();
  e.relative_rms = mean > 0 ? std::sqrt(e.relative_rms / pixels) / mean : 0;
  e.share_above /= pixels;
  return e;
}

double Rendering::estimated_error() const {
  return picture_error(film_, plan_.window);
}

double Rendering::share_done() const {
  return std::min(1.0,
                  double(progress_.tiles_done) /
                      double(book_.size() * (further_.steps().first + further_.steps().further)));
}

Counters Rendering::counters() const {
  Counters sum = book_.counters();
  for (const TileWork& w : work_) sum += w.counters;  // work of interrupted tiles
  return sum;
}

// Does these steps for those of the tiles, in this order, that have not done them yet.
void Rendering::step(const StepSpan& steps, const Tiles& tiles, const Act& act) {
  if (options_.group != nullptr) return share_steps(steps, tiles, act);
  for (uint32_t number = steps.first; number < steps.end; ++number) {
    Tiles left;
    for (const size_t t : tiles)
      if (book_.steps(t) == number) left.push_back(t);
    std::atomic<size_t> next = 0;
    parallel_for_slots(left.size(), options_.threads, [&](size_t, size_t slot) {
      do_step(number, left[next.fetch_add(1)], slot, act);
    });
    if (progress_.was_stopped) return;
  }
}

// Returns false if it was stopped.
bool Rendering::do_step(uint32_t number, size_t t, size_t slot, const Act& act) {
  if (stop_.load(std::memory_order_relaxed)) {
    progress_.was_stopped = true;
    return false;
  }
  TileWork& w = work_[slot];
  tracer_.begin(w);
  w.before = book_.state(t).counters;
  book_.begin(t, slot, [&](std::vector<uint8_t>& out) { archive_.save_tile(t, out); });
  if (!act(number, plan_.tiles[t], w)) {
    progress_.was_stopped = true;
    return false;
  }
  // errors thrown by callbacks name a ray
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  book_.finish(slot, w.counters);
  w.counters = {};
  if (!leads()) return true;
  tell_progress(t, number);
  save_in_time();
  return true;
}

// Reports progress. No other thread may work on the tile.
void Rendering::tell_progress(size_t tile, uint32_t step) {
  const PixelRect& r = plan_.tiles[tile];
  if (options_.preview != nullptr) options_.preview->update(film_, r);
  {
    const std::lock_guard lock(progress_.mutex);
    if (step == 0) {
      progress_.gaps -= common_pixels(r, plan_.window);
      set_seconds_per_gap(progress_.seconds_per_gap);
    }
    const TileSteps& all = further_.steps();
    const bool is_surrogate = step >= all.first && step < all.first + all.surrogates;
    if (!is_surrogate) ++progress_.tiles_done;
    if (report_) report_(share_done());
  }
}

void Rendering::save_in_time() {
  if (options_.checkpoint != nullptr && options_.checkpoint->take_turn())
    archive_.save(*options_.checkpoint);
}

// True if the work may end after a step. later: tiles that would continue.
bool Rendering::is_good_enough(uint32_t step, const Tiles& later) {
  if (!(options_.error_limit > 0)) return false;
  // A tile that has passed this step proves that an earlier check found the error too large.
  bool has_gone_on = false;
  for (const size_t t : later) has_gone_on |= book_.steps(t) > step + 1;
  return agree(leads() && !has_gone_on && estimated_error() <= options_.error_limit);
}

Rendering::Tiles Rendering::all_tiles() const {
  Tiles tiles(plan_.tiles.size());
  std::iota(tiles.begin(), tiles.end(), size_t(0));
  return tiles;
}

double Rendering::mean_luminance(const PixelRect& w) const {
  double sum = 0;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) sum += film_.estimate(x, y).luminance;
  return sum / (double(w.width()) * w.height());
}

double Rendering::typical_luminance() {
  if (!typical_) typical_ = tracer_.typical_luminance(plan_.image, work_[0]);
  return *typical_;
}

void Rendering::restore() {
  archive_.restore(*options_.checkpoint);
  const TileSteps& all = further_.steps();
  for (size_t t = 0; t < book_.size(); ++t) {
    const uint32_t steps = book_.steps(t);
    if (steps > 0) progress_.gaps -= common_pixels(plan_.tiles[t], plan_.window);
    progress_.tiles_done += steps - (steps > all.first ? all.surrogates : 0);
  }
}

bool Rendering::leads() const {
  return options_.group == nullptr || options_.group->leads();
}

// Returns rank 0's value to all processes.
bool Rendering::agree(bool value) {
  if (options_.group == nullptr) return value;
  std::vector<uint8_t> bytes{uint8_t(value)};
  if (options_.group->tell(bytes, stop_)) return bytes.front() != 0;
  progress_.was_stopped = true;
  return false;
}

// Without limits, a tile does as many steps at a time as possible, which saves messages. A picture
// that may have to end early advances evenly instead.
void Rendering::agree_on_limits() {
  if (options_.group != nullptr) progress_.is_stepwise = agree(is_limited());
}

// Takes over a tile that another process has worked on; called by rank 0.
void Rendering::take_over(size_t tile, ByteReader in) {
  const TileBook::State state = RenderingArchive::received_state(in);
  const uint32_t before = book_.steps(tile);
  book_.replace(tile, state, [&] { archive_.load_pixels(tile, in); });
  for (uint32_t s = before; s < state.steps; ++s) tell_progress(tile, s);
}

void Rendering::share_steps(const StepSpan& steps, const Tiles& tiles, const Act& act) {
  SharedWork work;
  work.items = book_.size();
  work.threads = options_.threads;
  work.is_for_all = false;
  work.has_order = leads();
  for (const size_t t : tiles)
    if (leads() && book_.steps(t) >= steps.first && book_.steps(t) < steps.end)
      work.order.push_back(t);
  work.act = [&](size_t t, size_t slot) {
    for (uint32_t number = book_.steps(t); number < steps.end; ++number)
      if (!do_step(number, t, slot, act)) return false;
    return true;
  };
  work.save = [&](size_t t, SharedWork::Bytes& out) { archive_.send_tile(t, out); };
  work.load = [&](size_t t, ByteReader in) { take_over(t, in); };
  work.brief = [&](size_t t, SharedWork::Bytes& out) {
    if (book_.steps(t) > 0) archive_.send_brief(t, out);
  };
  work.take_brief = [&](size_t t, ByteReader in) {
    if (in.left() > 0) archive_.receive_brief(t, in);
  };
  if (!options_.group->share(work, stop_)) progress_.was_stopped = true;
}

// Gives all processes the records of the first pass: patterns are compared with those of
// neighbours, which another process may have computed.
void Rendering::share_records() {
  std::vector<uint8_t> bytes;
  if (leads()) archive_.send_records(bytes);
  if (!options_.group->tell(bytes, stop_))
    progress_.was_stopped = true;
  else if (!leads())
    archive_.receive_records(ByteReader(bytes));
}

}  // namespace troffer
