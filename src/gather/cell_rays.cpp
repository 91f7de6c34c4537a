#include "gather/cell_rays.h"

#include <algorithm>

#include "base/error.h"

namespace troffer {

namespace {

constexpr size_t rays_at_a_time = 1024;
// Limit of sub-cell features that a ray resolves in succession; it then reads the next one's cell.
constexpr int most_close = 8;

struct RayWorker {
  GatherScratch gather;
  std::vector<GatherArrival> close;  // hits on sub-cell features
  std::vector<uint32_t> tasks;       // task of each ray
  std::vector<float> scales;  // per task of a chunk: rays over the sum of their coats' factors
  Counters counters;
};

struct Chunk {
  size_t first = 0, last = 0;  // range of tasks
  std::vector<CellSeen> seen;
  std::vector<CellEscape> escapes;
};

std::vector<Chunk> chunks_of(std::span<const CellTask> tasks) {
  std::vector<Chunk> chunks;
  size_t rays = rays_at_a_time;
  for (size_t t = 0; t < tasks.size(); ++t) {
    if (rays >= rays_at_a_time) {
      chunks.emplace_back().first = t;
      rays = 0;
    }
    rays += tasks[t].count;
    chunks.back().last = t + 1;
  }
  return chunks;
}

std::string name_of_ray(const void* worker, size_t i) {
  return "ray of cell task " + std::to_string(static_cast<const RayWorker*>(worker)->tasks[i]);
}

// Traces the rays of a chunk of tasks. A coat's factors have a mean of 1, which the few rays of a
// task miss. They are normalised by the task's own mean. Otherwise cells that see each other head
// on would amplify light at every bounce.
void trace_chunk(const GatherWalks& walks, const CellMap* map, std::span<const CellTask> tasks,
                 Chunk& chunk, std::vector<Rgb>& emission, RayWorker& w) {
  GatherScratch& g = w.gather;
  g.walks.clear();
  w.tasks.clear();
  w.scales.assign(chunk.last - chunk.first, 1);
  for (size_t t = chunk.first; t < chunk.last; ++t) {
    if (tasks[t].from.empty()) continue;  // in a damaged file of cells
    float shares = 0;
    for (uint32_t k = 0; k < tasks[t].count; ++k) {
      Walk walk;
      walk.index = uint32_t(w.tasks.size());
      walk.stream = tasks[t].stream;
      walk.sample = tasks[t].first + k;
      w.tasks.push_back(uint32_t(t));
      const CellHit& from = tasks[t].from[walk.sample % tasks[t].from.size()];
      shares += walks.leave(from, direction_number(walk), walk);
      if (!walk.throughput.is_black()) g.walks.push_back(walk);
    }
    if (shares > 0) w.scales[t - chunk.first] = float(tasks[t].count) / shares;
  }
  const CheckContext context(&w, w.tasks.size(), name_of_ray);
  g.is_of_rows = true;
  for (int bounce = 0; !g.walks.empty(); ++bounce) {
    walks.follow(w.tasks.size(), Coherence::none, g, w.counters);
    w.close.clear();
    for (const GatherEscape& e : g.escapes) {
      const uint32_t task = w.tasks[e.index];
      chunk.escapes.push_back({task, e.direction, e.throughput * w.scales[task - chunk.first]});
    }
    for (const GatherArrival& a : g.arrivals) {
      const uint32_t cell = map != nullptr ? map->find(a.hit, a.distance) : no_cell;
      const bool is_narrow = cell != no_cell
                                 ? map->is_narrow(cell)
                                 : map != nullptr && map->would_be_narrow(a.hit, a.distance);
      if (is_narrow && bounce < most_close) {
        w.close.push_back(a);
        continue;
      }
      CellSeen& seen = chunk.seen.emplace_back();
      seen.task = w.tasks[a.walk.index];
      seen.weight = a.walk.throughput * w.scales[seen.task - chunk.first];
      seen.distance = a.distance;
      seen.hit = a.hit;
      seen.cell = cell;
    }
    keep_one_of_each(w.close);
    if (!w.close.empty()) walks.sample_direct_light(w.close, g, w.counters);
    for (size_t i = 0; i < w.tasks.size(); ++i)
      emission[w.tasks[i]] +=
          (g.light.direct[i] + g.light.indirect[i]) * (pi_f * w.scales[w.tasks[i] - chunk.first]);
    walks.bounce(w.close, g);
  }
  // Hits by way of mirrors or sub-cell features are out of order.
  std::stable_sort(chunk.seen.begin(), chunk.seen.end(),
                   [](const CellSeen& a, const CellSeen& b) { return a.task < b.task; });
  std::stable_sort(chunk.escapes.begin(), chunk.escapes.end(),
                   [](const CellEscape& a, const CellEscape& b) { return a.task < b.task; });
}

}  // namespace

void trace_cell_rays(const GatherWalks& walks, const CellMap* map, std::span<const CellTask> tasks,
                     int threads, ProcessGroup* group, const StopFlag& stop, CellsSeen& out,
                     Counters& counters) {
  out.seen.clear();
  out.escapes.clear();
  out.emission.assign(tasks.size(), Rgb{0});
  std::vector<Chunk> chunks = chunks_of(tasks);
  std::vector<RayWorker> workers(size_t(thread_count(threads)));
  for (RayWorker& w : workers) w.gather.keeps_escapes = out.keeps_escapes;
  SharedWork work;
  work.items = chunks.size();
  work.threads = threads;
  work.act = [&](size_t c, size_t slot) {
    trace_chunk(walks, map, tasks, chunks[c], out.emission, workers[slot]);
    return true;
  };
  const auto emission_of = [&](const Chunk& c) {
    return std::span(out.emission).subspan(c.first, c.last - c.first);
  };
  work.save = [&](size_t c, SharedWork::Bytes& bytes) {
    append_all(bytes, std::span<const CellSeen>(chunks[c].seen));
    append_all(bytes, std::span<const CellEscape>(chunks[c].escapes));
    for (const Rgb& e : emission_of(chunks[c])) append(bytes, e);
  };
  work.load = [&](size_t c, ByteReader in) {
    chunks[c].seen = next_all<CellSeen>(in);
    chunks[c].escapes = next_all<CellEscape>(in);
    for (Rgb& e : emission_of(chunks[c])) e = in.next<Rgb>();
  };
  share(group, work, stop);
  for (const RayWorker& w : workers) counters += w.counters;
  for (const Chunk& c : chunks) {
    out.seen.insert(out.seen.end(), c.seen.begin(), c.seen.end());
    out.escapes.insert(out.escapes.end(), c.escapes.begin(), c.escapes.end());
  }
}

}  // namespace troffer
