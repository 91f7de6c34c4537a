#include "annual/reflected_light.h"

#include <atomic>
#include <mutex>

#include "annual/block_solver.h"
#include "base/streams.h"

namespace troffer {

namespace {

// One replicate of all states of a family.
class ReplicateWork {
 public:
  ReplicateWork(const StateFamily& family, const WeatherYear& year, const Compass& compass,
                const ReflectedOptions& options, size_t replicate, const StopFlag& stop)
      : family_(family),
        options_(options),
        replicate_(replicate),
        seed_(hash_of(options.seed, uint64_t(replicate), stream::annual_replicates)),
        stop_(stop),
        suns_(suns_of(year)),
        sources_(compass, suns_->nodes(), options.subdivision) {}

  // Computes the replicate of all states that need it. Returns false once `stop` is set.
  bool compute(const ProgressCallback& progress) {
    find_kept();
    if (wanted_.empty()) return true;
    const StateOfFamily& first = family_.states[0];
    const TransportCells cells(*first.scene, family_.sensors, options_.rays, family_.regions, seed_,
                               options_.threads, stop_);
    std::vector<std::unique_ptr<const StateCells>> own(family_.states.size());
    for (const size_t k : wanted_) {
      const StateOfFamily& state = family_.states[k];
      if (k > 0 && !stop_.load())
        own[k] = std::make_unique<StateCells>(cells, *state.scene, family_.regions, state.region,
                                              options_.rays, seed_, options_.threads, stop_);
      prepare(cells, own[k].get(), states_[k]);
    }
    if (stop_.load()) return false;
    solve(cells, own, progress);
    if (stop_.load()) return false;
    for (const size_t k : wanted_)
      if (options_.keeper != nullptr)
        options_.keeper->keep(family_.states[k].number, replicate_, states_[k]);
    return true;
  }
  std::vector<ReflectedReplicate>& states() { return states_; }

 private:
  std::shared_ptr<const SunGrid> suns_of(const WeatherYear& year) const {
    Random shift(hash_of(seed_, stream::annual_sun_grid));
    const double x = shift.next_double();
    return std::make_shared<const SunGrid>(year.latitude_deg, year.steps,
                                           Vec2d{x, shift.next_double()});
  }
  void find_kept() {
    ReplicateKeeper* keeper = options_.keeper;
    for (size_t k = 0; k < family_.states.size(); ++k) {
      ReflectedReplicate& out = states_.emplace_back();
      out.suns = suns_;
      out.sources = sources_.size();
      const size_t number = family_.states[k].number;
      if (keeper == nullptr || (!keeper->find(number, replicate_, family_.sensors.size(), out) &&
                                keeper->is_own(number, replicate_)))
        wanted_.push_back(k);
    }
  }
  void prepare(const TransportCells& cells, const StateCells* own, ReflectedReplicate& out) const {
    out.cells = cells.cell_count();
    out.links = cells.rows().cells.all().size();
    if (own != nullptr) {
      out.cells += own->cell_count();
      out.links += own->rows().cells.all().size() + own->more_of_rows().cells.all().size();
    }
    out.coefficients.resize(family_.sensors.size() * out.sources);
  }
  void solve(const TransportCells& cells, const std::vector<std::unique_ptr<const StateCells>>& own,
             const ProgressCallback& progress) {
    const std::vector<uint32_t> order = sources_.by_azimuth();
    const size_t blocks = (order.size() + SourceBlock::most - 1) / SourceBlock::most;
    std::atomic<size_t> done = 0;
    std::mutex telling;
    parallel_for(blocks, options_.threads, [&](size_t b) {
      if (stop_.load()) return;
      const size_t begin = b * SourceBlock::most;
      const auto numbers =
          std::span(order).subspan(begin, std::min(SourceBlock::most, order.size() - begin));
      const SourceBlock block(sources_, numbers, seed_);
      const SharedBlockLight shared(cells, family_.states[0].scene->tracer, block, family_.regions);
      for (const size_t k : wanted_) {
        if (stop_.load()) return;
        const StateOfFamily& state = family_.states[k];
        BlockSolver solver(cells, shared, own[k].get(), state.scene->tracer, block, state.region);
        solver.solve();
        ReflectedReplicate& out = states_[k];
        for (size_t s = 0; s < family_.sensors.size(); ++s)
          solver.gather(s, std::span(out.coefficients).subspan(s * out.sources, out.sources));
      }
      const double fraction = double(++done) / double(blocks);
      const std::lock_guard lock(telling);
      if (progress) progress(fraction);
    });
  }

  const StateFamily& family_;
  const ReflectedOptions& options_;
  size_t replicate_;
  uint64_t seed_;
  const StopFlag& stop_;
  std::shared_ptr<const SunGrid> suns_;
  OutsideSources sources_;
  std::vector<ReflectedReplicate> states_;
  std::vector<size_t> wanted_;  // states that are neither kept nor another process' share
};

}  // namespace

std::vector<std::vector<ReflectedReplicate>> reflected_light(
    const StateFamily& family, const WeatherYear& year, const Compass& compass,
    const ReflectedOptions& options, const ProgressCallback& progress, const StopFlag& stop) {
  std::vector<std::vector<ReflectedReplicate>> out(family.states.size());
  for (int r = 0; r < replicate_count; ++r) {
    ReplicateWork work(family, year, compass, options, size_t(r), stop);
    const auto tell = [&](double f) {
      if (progress) progress((r + f) / replicate_count);
    };
    if (!work.compute(tell)) break;
    for (size_t k = 0; k < out.size(); ++k) out[k].push_back(std::move(work.states()[k]));
  }
  return out;
}

}  // namespace troffer
