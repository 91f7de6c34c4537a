#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/parallel.h"
#include "experiments.h"
#include "figures.h"
#include "generated_scenes.h"
#include "import/import.h"
#include "methods.h"

namespace troffer::bench {

void append_row(const std::string& folder, const std::string& file, const std::string& header,
                const std::string& row) {
  if (folder.empty()) return;
  const std::string path = folder + "/" + file;
  const bool is_new = !std::filesystem::exists(path);
  std::ofstream out(path, std::ios::app);
  if (is_new) out << header << '\n';
  out << row << '\n';
  if (!out.flush()) throw EnvironmentError("cannot write " + path);
}

namespace {

Scene scene_named(const std::string& name) {
  if (name == "clutter") return clutter();
  if (name == "foliage") return foliage();
  for (ThinScene& t : thin_scenes())
    if (name == t.name) return std::move(t.scene);
  for (const char* folder : {"/scenes/", "/../shared/scenes/"}) {
    const std::string path = std::string(TROFFER_SOURCE_DIR) + folder + name;
    if (std::filesystem::exists(path)) return import_scene(path);
  }
  throw EnvironmentError("there is no scene " + name);
}

std::string short_name(const std::string& scene) {
  return std::filesystem::path(scene).stem().string();
}

void describe(const Arguments& a, const Pairs& p, const Reference& reference) {
  size_t lit = 0, dark = 0;
  for (const float v : p.reference) {
    lit += v == 1 ? 1 : 0;
    dark += v == 0 ? 1 : 0;
  }
  const auto n = double(p.counted);
  const size_t triangles = triangle_count(p.scene.prepared.scene);
  fmt::print(
      "{} ({}): {} triangles, {} facets, {} flat sources, {} hits, {} pairs, {} counted "
      "({} more in their source's plane)\n",
      p.scene.name, a.view_name, triangles, p.scene.occluders.facet_count(), p.scene.sources.size(),
      p.hits, p.reachable, p.counted, p.in_plane);
  if (p.scene.left_out > 0)
    fmt::print("  {} pieces of emitters are not flat and left out\n", p.scene.left_out);
  fmt::print(
      "  reference: {} × {} rays{}; its rms error {:.6f}, of the mean {:.7f}; {:.1f} % of pairs "
      "open, {:.1f} % hidden\n",
      a.reference.replicates, a.reference.rays, reference.was_kept ? " (kept)" : "",
      reference.rms_error, reference.mean_error, 100 * double(lit) / n, 100 * double(dark) / n);
  append_row(a.csv_folder, "pairs.csv",
             "scene,view,width,height,spp,triangles,sources,hits,pairs,counted,open,hidden,"
             "reference_rays,reference_rms_error",
             fmt::format("{},{},{},{},{},{},{},{},{},{},{:.4f},{:.4f},{},{:.3g}", p.scene.name,
                         a.view_name, a.view.width, a.view.height, a.view.spp, triangles,
                         p.scene.sources.size(), p.hits, p.reachable, p.counted, double(lit) / n,
                         double(dark) / n, a.reference.rays * a.reference.replicates,
                         reference.rms_error));
}

// Runs a method once per seed. Errors cover all runs; the time is that of the fastest.
template <class Run>
Answers measure(const Arguments& a, const Pairs& p, const std::string& method, double setting,
                int repeats, Run&& run) {
  Answers answers;
  Figures all;
  double seconds = 0;
  for (int k = 0; k < repeats; ++k) {
    run(uint64_t(k) + 1, answers);
    const Figures f = figures_of(p, answers);
    all.rms += f.rms * f.rms / repeats;
    all.rms_light += f.rms_light * f.rms_light / repeats;
    all.predicted += f.predicted * f.predicted / repeats;
    all.mean += f.mean / repeats;
    all.worst = std::max(all.worst, f.worst);
    seconds = k == 0 ? answers.seconds : std::min(seconds, answers.seconds);
  }
  const double rms = std::sqrt(all.rms), light = std::sqrt(all.rms_light);
  const double predicted = std::sqrt(all.predicted);
  const double per_pair = 1e9 * seconds / double(p.reachable);
  const double per_hit = 1e9 * seconds / double(p.hits);
  const double rays = double(answers.rays) / double(p.hits);
  fmt::print(
      "  {:<22} {:<7g} rms {:.5f}  of light {:.5f}  worst {:.3f}  {:9.1f} ns a pair  "
      "{:10.1f} ns a hit  {:9.2f} rays a hit\n",
      method, setting, rms, light, all.worst, per_pair, per_hit, rays);
  append_row(a.csv_folder, "curves.csv",
             "scene,view,method,setting,rms_visible,rms_light,mean_visible,worst_visible,"
             "predicted_visible,ns_pair,ns_hit,rays_hit",
             fmt::format("{},{},{},{:g},{:.4g},{:.4g},{:.3g},{:.4g},{:.4g},{:.5g},{:.5g},{:.5g}",
                         p.scene.name, a.view_name, method, setting, rms, light, all.mean,
                         all.worst, predicted, per_pair, per_hit, rays));
  return answers;
}

void describe_answers(const Arguments& a, const Pairs& p, double error, const Answers& answers) {
  const auto n = double(p.counted);
  const KindFigures lit = figures_of_kind(p, answers, ShadowAnswer::lit);
  const KindFigures dark = figures_of_kind(p, answers, ShadowAnswer::dark);
  const KindFigures masked = figures_of_kind(p, answers, ShadowAnswer::masked);
  const KindFigures mixed = figures_of_kind(p, answers, ShadowAnswer::mixed);
  const double open = worst_where_open(p, answers);
  fmt::print(
      "      lit {:.1f} %  dark {:.1f} %  masked {:.1f} % (rms {:.4f}, told {:.4f})  mixed {:.1f} "
      "% (rms {:.4f}, told {:.4f}); nothing hidden: off by {:.2g} at most; {} contradictions\n",
      100 * double(lit.pairs) / n, 100 * double(dark.pairs) / n, 100 * double(masked.pairs) / n,
      masked.rms, masked.predicted, 100 * double(mixed.pairs) / n, mixed.rms, mixed.predicted, open,
      contradictions(p, answers));
  append_row(
      a.csv_folder, "answers.csv",
      "scene,view,error,lit,dark,masked,masked_rms,masked_predicted,mixed,mixed_rms,"
      "mixed_predicted,worst_where_open,contradictions",
      fmt::format("{},{},{:g},{:.4f},{:.4f},{:.4f},{:.4g},{:.4g},{:.4f},{:.4g},{:.4g},{:.3g},{}",
                  p.scene.name, a.view_name, error, double(lit.pairs) / n, double(dark.pairs) / n,
                  double(masked.pairs) / n, masked.rms, masked.predicted, double(mixed.pairs) / n,
                  mixed.rms, mixed.predicted, open, contradictions(p, answers)));
}

CertifiedOptions options_for(const DirectScene& s, double error) {
  return certified_settings(error, s.prepared.scene.lights.size()).estimator;
}

// Only packets go on to small errors: from 16 rays on single rays are slower everywhere.
uint32_t most_rays(const Arguments& a, Traversal traversal) {
  if (a.is_quick) return 256;
  return traversal == Traversal::single ? 1024 : 4096;
}

}  // namespace

void curves(const Arguments& a) {
  const DirectScene scene(short_name(a.scene), scene_named(a.scene));
  Pairs p(scene, a.view);
  describe(a, p, make_reference(p, a.reference));
  const int repeats = a.is_quick ? 2 : 3;
  for (const double error : {0.04, 0.02, 0.01, 0.005, 0.0025, 0.001, 0.0005}) {
    if (a.is_quick && error != 0.02 && error != 0.01 && error != 0.0025 && error != 0.001) continue;
    const Answers answers =
        measure(a, p, "certified", error, repeats, [&](uint64_t seed, Answers& out) {
          run_certified(p, options_for(scene, error), seed, out);
        });
    describe_answers(a, p, error, answers);
  }
  for (const Traversal traversal : {Traversal::packets, Traversal::single})
    for (uint32_t n = 4; n <= most_rays(a, traversal); n *= a.is_quick ? 4 : 2)
      measure(a, p, traversal == Traversal::single ? "fixed single" : "fixed packets", n,
              n <= 128 ? repeats : 1,
              [&](uint64_t seed, Answers& out) { run_fixed(p, n, traversal, seed, out); });
  for (const bool has_coherence : {false, true})
    for (const float allowed : {0.08f, 0.04f, 0.02f, 0.01f, 0.005f, 0.0025f}) {
      if (a.is_quick && allowed != 0.04f && allowed != 0.01f) continue;
      BintreeOptions options;
      options.allowed_variance = allowed;
      measure(a, p, has_coherence ? "kj92 coherence" : "kj92 alone", double(allowed), repeats - 1,
              [&](uint64_t seed, Answers& out) { run_kj92(p, options, has_coherence, seed, out); });
    }
}

void bias(const Arguments& a) {
  const DirectScene scene(short_name(a.scene), scene_named(a.scene));
  Pairs p(scene, a.view);
  const Reference reference = make_reference(p, a.reference);
  describe(a, p, reference);
  for (const double error : {0.01, 0.002}) {
    std::vector<double> means(a.seeds);
    std::vector<Answers> memory(size_t(thread_count(0)));
    parallel_for_slots(a.seeds, 0, [&](size_t seed, size_t slot) {
      run_certified(p, options_for(scene, error), 100 + seed, memory[slot]);
      means[seed] = figures_of(p, memory[slot]).mean;
    });
    double sum = 0, sum2 = 0;
    for (const double m : means) sum += m;
    const auto n = double(a.seeds);
    const double mean = sum / n;
    for (const double m : means) sum2 += (m - mean) * (m - mean);
    const double own = std::sqrt(sum2 / (n * (n - 1)));
    const double both = std::hypot(own, reference.mean_error);
    const double errors = both > 0 ? mean / both : 0;
    fmt::print(
        "  --error {:<6g} mean error over {} seeds {:+.7f} ± {:.7f}, reference ± {:.7f}: "
        "{:+.2f} standard errors\n",
        error, a.seeds, mean, own, reference.mean_error, errors);
    append_row(a.csv_folder, "bias.csv",
               "scene,error,pairs,seeds,mean_error,standard_error,reference_standard_error,"
               "in_standard_errors",
               fmt::format("{},{:g},{},{},{:.4g},{:.3g},{:.3g},{:.3g}", p.scene.name, error,
                           p.counted, a.seeds, mean, own, reference.mean_error, errors));
  }
}

void thin(const Arguments& a) {
  for (ThinScene& t : thin_scenes()) {
    if (!a.only.empty() && a.only != t.name) continue;
    const DirectScene scene(t.name, std::move(t.scene));
    Pairs p(scene, a.view);
    make_reference(p, a.reference);
    Answers answers;
    run_certified(p, options_for(scene, a.error), 1, answers);
    const Figures f = figures_of(p, answers);
    double hidden = 0, found = 0;
    for (size_t i = 0; i < p.size(); ++i) {
      if (p.is_counted[i] == 0) continue;
      hidden += 1 - double(p.reference[i]);
      found += 1 - double(answers.visible[i]);
    }
    const auto n = double(p.counted);
    const size_t wrong = contradictions(p, answers);
    fmt::print(
        "  {:<17} hidden {:7.4f} %, found {:7.4f} %  mean error {:.4f} %  largest {:.3f} %  "
        "signed {:+.5f} %  {} contradictions in {} pairs\n",
        scene.name, 100 * hidden / n, 100 * found / n, 100 * f.mean_size, 100 * f.worst,
        100 * f.mean, wrong, p.counted);
    append_row(a.csv_folder, "thin.csv",
               "scene,what,error,triangles,pairs,hidden,hidden_found,mean_size_of_error,"
               "largest_error,contradictions",
               fmt::format("{},\"{}\",{:g},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{}", scene.name,
                           t.what, a.error, triangle_count(scene.prepared.scene), p.counted,
                           hidden / n, found / n, f.mean_size, f.worst, wrong));
  }
}

}  // namespace troffer::bench
