// Log of warnings. Importers and options add to it, and app/ prints it once. Equal messages share
// an entry with a count.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace troffer {

struct Warning {
  std::string text;
  size_t count = 1;
};

// Not thread-safe. Keeps at most `max_entries` different texts, so that a hostile file cannot fill
// memory; the rest are counted in one last entry.
class WarningLog {
 public:
  void add(std::string text, size_t count = 1);
  const std::vector<Warning>& entries() const { return entries_; }
  size_t total() const;

 private:
  static constexpr size_t max_entries = 200;
  std::vector<Warning> entries_;
};

}  // namespace troffer
