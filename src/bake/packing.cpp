#include "bake/packing.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace troffer {

namespace {

struct Item {
  size_t group, number;
  TexelSize size;
};

// Tall rectangles come first; low ones fill the gaps.
void sort_for_packing(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.size.height != b.size.height ? a.size.height > b.size.height
                                          : a.size.width > b.size.width;
  });
}

std::vector<Item> items_of(const PackGroup& group, size_t number) {
  std::vector<Item> items;
  for (size_t i = 0; i < group.sizes.size(); ++i) items.push_back({number, i, group.sizes[i]});
  return items;
}

int64_t area_of(const PackGroup& group) {
  int64_t sum = 0;
  for (const TexelSize& s : group.sizes) sum += int64_t(s.width) * s.height;
  return sum;
}

bool add_all(std::vector<Item> items, Skyline& page, std::vector<PackGroup>& groups) {
  sort_for_packing(items);
  for (const Item& item : items)
    if (!page.add(item.size, groups[item.group].at[item.number])) return false;
  return true;
}

bool pack_on_one(std::vector<PackGroup>& groups, int size) {
  std::vector<Item> all;
  for (size_t g = 0; g < groups.size(); ++g)
    for (const Item& item : items_of(groups[g], g)) all.push_back(item);
  Skyline page(size);
  if (!add_all(std::move(all), page, groups)) return false;
  for (PackGroup& g : groups) g.page = 0;
  return true;
}

}  // namespace

int Skyline::row_at(size_t i, const TexelSize& r) const {
  if (parts_[i].x + r.width > size_) return -1;
  int row = 0;
  for (int left = r.width; left > 0; ++i) {
    row = std::max(row, parts_[i].y);
    left -= parts_[i].width;
  }
  return row + r.height <= size_ ? row : -1;
}

bool Skyline::add(const TexelSize& r, TexelAt& at) {
  size_t best = parts_.size();
  int row = size_ + 1;
  for (size_t i = 0; i < parts_.size(); ++i) {
    const int y = row_at(i, r);
    if (y >= 0 && y < row) row = y, best = i;
  }
  if (best == parts_.size()) return false;
  at = {parts_[best].x, row};
  const int end = at.x + r.width;
  size_t last = best;
  while (last < parts_.size() && parts_[last].x + parts_[last].width <= end) ++last;
  if (last < parts_.size() && parts_[last].x < end) {
    parts_[last].width -= end - parts_[last].x;
    parts_[last].x = end;
  }
  parts_.erase(parts_.begin() + std::ptrdiff_t(best), parts_.begin() + std::ptrdiff_t(last));
  parts_.insert(parts_.begin() + std::ptrdiff_t(best), {at.x, row + r.height, r.width});
  // Merge neighbouring parts of equal height.
  for (size_t i = best > 0 ? best - 1 : 0; i + 1 < parts_.size() && i <= best;) {
    if (parts_[i].y != parts_[i + 1].y) {
      ++i;
      continue;
    }
    parts_[i].width += parts_[i + 1].width;
    parts_.erase(parts_.begin() + std::ptrdiff_t(i) + 1);
  }
  return true;
}

int pack(std::vector<PackGroup>& groups, int size, int most_pages) {
  for (PackGroup& g : groups) g.at.assign(g.sizes.size(), {});
  int64_t area = 0;
  for (const PackGroup& g : groups) area += area_of(g);
  if (area > int64_t(size) * size * most_pages) return 0;
  if (area <= int64_t(size) * size && pack_on_one(groups, size)) return 1;
  if (most_pages == 1) return 0;
  std::vector<size_t> order(groups.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return area_of(groups[a]) > area_of(groups[b]); });
  std::vector<Skyline> pages;
  for (const size_t g : order) {
    groups[g].page = -1;
    for (size_t p = 0; groups[g].page < 0; ++p) {
      const bool is_new = p == pages.size();
      if (is_new && int(p) == most_pages) return 0;
      Skyline trial = is_new ? Skyline(size) : pages[p];
      if (add_all(items_of(groups[g], g), trial, groups)) {
        if (is_new) pages.push_back(Skyline(size));
        pages[p] = std::move(trial);
        groups[g].page = int(p);
      } else if (is_new) {
        return 0;
      }
    }
  }
  return int(pages.size());
}

}  // namespace troffer
