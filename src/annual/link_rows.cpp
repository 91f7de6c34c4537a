#include "annual/link_rows.h"

#include <algorithm>

namespace troffer {

namespace {

// Largest sum of a row. Rows of matte surfaces stay below one; roulette at gloss may exceed it.
constexpr float most_of_row = 0.99f;

}  // namespace

void merge_links(std::vector<CellLink>& links) {
  std::stable_sort(links.begin(), links.end(),
                   [](const CellLink& a, const CellLink& b) { return a.cell < b.cell; });
  size_t kept = 0;
  for (size_t i = 0; i < links.size(); ++i)
    if (kept > 0 && links[kept - 1].cell == links[i].cell)
      links[kept - 1].weight += links[i].weight;
    else
      links[kept++] = links[i];
  links.resize(kept);
}

bool are_grey(const LinkRows<CellLink>& rows) {
  const std::span<const CellLink> all = rows.all();
  return std::all_of(all.begin(), all.end(), [](const CellLink& l) {
    return l.weight.r == l.weight.g && l.weight.g == l.weight.b;
  });
}

void add_rows(const CellsSeen& seen, std::span<const CellTask> tasks,
              std::span<const uint32_t> cells, std::vector<float>* scales, SightRows& rows) {
  std::vector<CellLink> links;
  std::vector<OutsideLink> ways;
  size_t at = 0, way = 0;
  for (size_t t = 0; t < tasks.size(); ++t) {
    links.clear();
    ways.clear();
    const float share = 1.0f / float(tasks[t].count);
    Rgb sum{0};
    for (; at < seen.seen.size() && seen.seen[at].task == t; ++at) {
      if (cells[at] == no_cell) continue;
      links.push_back({cells[at], seen.seen[at].weight * share});
      sum += links.back().weight;
    }
    for (; way < seen.escapes.size() && seen.escapes[way].task == t; ++way)
      ways.push_back({seen.escapes[way].direction, seen.escapes[way].weight * share});
    merge_links(links);
    if (scales != nullptr) {
      const float most = max_component(sum);
      scales->push_back(most > most_of_row ? most_of_row / most : 1.0f);
      for (CellLink& l : links) l.weight *= scales->back();
    }
    rows.cells.add(links);
    rows.outside.add(ways);
  }
}

}  // namespace troffer
