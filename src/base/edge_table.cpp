#include "base/edge_table.h"

namespace troffer {

void EdgeTable::clear(size_t edges) {
  size_t size = 16;
  while (size < 2 * edges) size *= 2;
  entries_.assign(size, {no_key, none});
  used_ = 0;
}

size_t EdgeTable::slot(uint64_t key) const {
  const size_t mask = entries_.size() - 1;
  size_t i = size_t((key * 0x9e3779b97f4a7c15ull) >> 20) & mask;
  while (entries_[i].first != key && entries_[i].first != no_key) i = (i + 1) & mask;
  return i;
}

uint32_t EdgeTable::find(uint32_t from, uint32_t to) const {
  return entries_[slot((uint64_t(from) << 32) + to)].second;
}

void EdgeTable::insert(uint32_t from, uint32_t to, uint32_t polygon) {
  const uint64_t key = (uint64_t(from) << 32) + to;
  size_t i = slot(key);
  if (entries_[i].first == key) {
    uint32_t& value = entries_[i].second;
    value = value == none ? polygon : many;
    return;
  }
  if (2 * (used_ + 1) > entries_.size()) {
    std::vector<std::pair<uint64_t, uint32_t>> old(2 * entries_.size(), {no_key, none});
    old.swap(entries_);
    for (const auto& e : old)
      if (e.first != no_key) entries_[slot(e.first)] = e;
    i = slot(key);
  }
  entries_[i] = {key, polygon};
  ++used_;
}

void EdgeTable::erase(uint32_t from, uint32_t to) {
  auto& entry = entries_[slot((uint64_t(from) << 32) + to)];
  if (entry.second != many) entry.second = none;
}

}  // namespace troffer
