#include "base/log.h"

#include <algorithm>

namespace troffer {

void WarningLog::add(std::string text, size_t count) {
  if (count == 0) return;
  if (entries_.size() >= max_entries) text = "further warnings of other kinds";
  const auto it = std::find_if(entries_.begin(), entries_.end(),
                               [&](const Warning& w) { return w.text == text; });
  if (it != entries_.end())
    it->count += count;
  else
    entries_.push_back({std::move(text), count});
}

size_t WarningLog::total() const {
  size_t n = 0;
  for (const Warning& w : entries_) n += w.count;
  return n;
}

}  // namespace troffer
