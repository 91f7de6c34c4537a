// Draws figures 4 and 5 of [1] from the bintree that rendering uses: how the subdivision of a
// source grows with its rays' results, and how it shrinks before the next point. The occluder is a
// straight edge across the source, so its visible share is known exactly.
//
//   kj92_bintree_figures FOLDER
//
// It writes figure4-a.png … figure4-i.png and figure5-a.png … figure5-c.png, which show the source
// as the square of its parameters (u to the right, v upward). figure4.csv and figure5.csv have one
// row per picture, leaves.csv one row per leaf of each picture.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §3 and §4.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "image/atomic_file.h"
#include "image/image.h"
#include "image/write_image.h"
#include "kj92/bintree.h"

using namespace troffer;

namespace {

constexpr int side = 240;           // size of a picture, px
constexpr double margin = 4;        // around the square
constexpr double ray_radius = 3.6;  // radius of the dot that marks a ray
const Rgb paper{1}, ink{0}, pencil{0.30f}, hidden_tint{0.72f, 0.72f, 0.76f};
const Rgb new_ring{0.80f, 0.10f, 0.02f}, forced_tint{1.0f, 0.66f, 0.25f};

// An occluder that hides all (u,v) below a straight edge through (½, height) with the given slope.
struct Edge {
  double height, slope;

  bool hides(Vec2 p) const { return double(p.y) < height + slope * (double(p.x) - 0.5); }
  // Exact if the edge crosses the left and the right side of the square.
  double visible_share() const { return 1 - height; }
};

struct Leaf {
  SourceCell cell;
  Vec2 ray;
  bool is_visible, is_new, is_forced;  // forced: new because of the level difference
};

// Contents of one picture.
struct Panel {
  std::vector<Leaf> leaves;
  std::string note;
  double mean = 0, standard_error = 0, exact = 0;
  size_t new_rays = 0, forced_rays = 0;
};

// Returns the tree's leaves with the results of their rays; those in `pending` count as answered.
// All but the first `chosen` pending rays come from the rule of the level difference.
Panel panel_of(const Bintree& tree, const Edge& edge, size_t chosen, std::string note) {
  Panel p;
  p.note = std::move(note);
  const std::span<const Vec2> pending = tree.pending();
  double covered = 0;
  tree.nodes().for_each_leaf([&](int32_t i) {
    const SourceCell cell = tree.nodes().cell(i);
    const Vec2 ray = tree.nodes()[i].uv;
    const auto at = std::find(pending.begin(), pending.end(), ray);
    const bool is_new = at != pending.end();
    const bool is_forced = is_new && size_t(at - pending.begin()) >= chosen;
    p.leaves.push_back({cell, ray, !edge.hides(ray), is_new, is_forced});
    covered += double(cell.measure());
    p.mean += double(cell.measure()) * !edge.hides(ray);
  });
  TROFFER_CHECK(std::abs(covered - 1) < 1e-6);
  p.exact = edge.visible_share();
  p.new_rays = pending.size();
  p.forced_rays = pending.size() - std::min(chosen, pending.size());
  return p;
}

// Returns the visibility of rays, as a query of the tree.
auto query_of(const Edge& edge) {
  return [edge](std::span<const Vec2> rays, std::span<ShadowRayResult> results) {
    for (size_t i = 0; i < rays.size(); ++i) results[i] = {!edge.hides(rays[i]), 1.0f};
  };
}

// [1] Figure 4: the initial rays, then every round. The tree splits as soon as it gets answers, so
// each picture is taken just before.
std::vector<Panel> refinement(const BintreeOptions& options, const Edge& edge, uint64_t stream,
                              size_t panels) {
  Bintree tree(options);
  tree.start(stream);
  std::vector<Panel> sequence;
  std::vector<ShadowRayResult> results;
  while (!tree.pending().empty() && sequence.size() < panels) {
    const bool is_first = sequence.empty();
    sequence.push_back(panel_of(tree, edge, is_first ? tree.pending().size() : 1,
                                is_first ? "initial rays" : "refined"));
    results.resize(tree.pending().size());
    query_of(edge)(tree.pending(), results);
    tree.supply(results);
    sequence.back().standard_error = std::sqrt(double(tree.estimate().variance));
  }
  return sequence;
}

// [1] Figure 5: the pattern at a point; at the next point, where the shadow has moved, with all
// leaves cast again and refined; and after shrinking.
std::vector<Panel> shrinking(const BintreeOptions& options, const Edge& here, const Edge& next,
                             uint64_t stream) {
  Bintree tree(options);
  std::vector<ShadowRayResult> results;
  std::vector<Panel> panels;
  const auto keep = [&](const Edge& edge, const char* note) {
    panels.push_back(panel_of(tree, edge, 0, note));
    panels.back().standard_error = std::sqrt(double(tree.estimate().variance));
  };
  sample_source(tree, results, stream, query_of(here));
  keep(here, "at a point");
  resample_source(tree, results, stream + 1, query_of(next));
  keep(next, "at the next point");
  tree.shrink();
  keep(next, "shrunk");
  return panels;
}

// Converts distances in pixels to coverage over one pixel's width.
float coverage(double distance) {
  return float(std::clamp(0.5 - distance, 0.0, 1.0));
}
Rgb over(Rgb below, Rgb above, float alpha) {
  return below * (1 - alpha) + above * alpha;
}

void draw_leaf(Image& image, const Leaf& leaf, Vec2d p, double scale, int x, int y) {
  const SourceCell& c = leaf.cell;
  const Vec2d low{margin + double(c.u0) * scale, margin + (1 - double(c.v1)) * scale};
  const Vec2d high{margin + double(c.u1) * scale, margin + (1 - double(c.v0)) * scale};
  const double outside =
      std::max({low.x - p.x, p.x - high.x, low.y - p.y, p.y - high.y});  // < 0 inside
  Rgb& pixel = image.at(x, y);
  if (leaf.is_forced && outside < 0) pixel = over(pixel, forced_tint, 0.55f);
  if (outside < 1) pixel = over(pixel, pencil, coverage(std::abs(outside) - 0.5));
}

void draw_ray(Image& image, const Leaf& leaf, Vec2d p, double scale, int x, int y) {
  const Vec2d centre{margin + double(leaf.ray.x) * scale,
                     margin + (1 - double(leaf.ray.y)) * scale};
  const double r = std::hypot(p.x - centre.x, p.y - centre.y);
  if (r > ray_radius + 4) return;
  Rgb& pixel = image.at(x, y);
  pixel = over(pixel, ink, coverage(r - ray_radius));
  if (leaf.is_visible) pixel = over(pixel, paper, coverage(r - ray_radius + 1.3));
  if (leaf.is_new) pixel = over(pixel, new_ring, coverage(std::abs(r - ray_radius - 2) - 0.8));
}

Image draw(const Panel& panel, const Edge& edge) {
  Image image(side, side, paper);
  const double scale = side - 2 * margin;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Vec2d p{x + 0.5, y + 0.5};
      const Vec2d uv{(p.x - margin) / scale, 1 - (p.y - margin) / scale};
      const bool is_inside = std::min(uv.x, uv.y) >= 0 && std::max(uv.x, uv.y) <= 1;
      if (is_inside && edge.hides(Vec2(uv))) image.at(x, y) = hidden_tint;
      for (const Leaf& leaf : panel.leaves) draw_leaf(image, leaf, p, scale, x, y);
      for (const Leaf& leaf : panel.leaves) draw_ray(image, leaf, p, scale, x, y);
    }
  }
  return image;
}

void write_figure(const std::string& folder, const std::string& figure,
                  const std::vector<Panel>& panels, const std::vector<Edge>& edges,
                  std::string& leaves_csv) {
  WriteOptions plain;
  plain.display.tone_map = ToneMap::none;
  std::string csv = "panel,step,rays,new_rays,level_difference_rays,mean,standard_error,exact\n";
  for (size_t i = 0; i < panels.size(); ++i) {
    const Panel& p = panels[i];
    const char letter = char('a' + i);
    write_image(fmt::format("{}/{}-{}.png", folder, figure, letter),
                draw(p, edges[std::min(i, edges.size() - 1)]), plain);
    csv += fmt::format("{},{},{},{},{},{:.4f},{:.4f},{:.4f}\n", letter, p.note, p.leaves.size(),
                       p.new_rays, p.forced_rays, p.mean, p.standard_error, p.exact);
    for (const Leaf& l : p.leaves) {
      leaves_csv += fmt::format("{},{},{},{},{},{},{:.5f},{:.5f},{},{},{}\n", figure, letter,
                                l.cell.u0, l.cell.u1, l.cell.v0, l.cell.v1, l.ray.x, l.ray.y,
                                int(l.is_visible), int(l.is_new), int(l.is_forced));
    }
  }
  write_file(folder + "/" + figure + ".csv", csv);
}

void run(const std::string& folder) {
  std::string leaves = "figure,panel,u0,u1,v0,v1,u,v,is_visible,is_new,is_level_difference\n";

  BintreeOptions options;
  options.initial_rays = 4;
  options.allowed_variance = 0.01f;
  const Edge edge{0.42, 0.45};
  const std::vector<Panel> grown = refinement(options, edge, 1, 9);
  TROFFER_CHECK(grown.size() == 9);
  write_figure(folder, "figure4", grown, {edge}, leaves);

  options.initial_rays = 8;
  options.allowed_variance = 0.065f;
  const Edge moved{0.72, 0.45};
  const std::vector<Panel> shrunk = shrinking(options, edge, moved, 3);
  TROFFER_CHECK(shrunk[2].leaves.size() < shrunk[1].leaves.size());
  write_figure(folder, "figure5", shrunk, {edge, moved, moved}, leaves);

  write_file(folder + "/leaves.csv", leaves);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: kj92_bintree_figures FOLDER\n");
    return 2;
  }
  try {
    run(argv[1]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
