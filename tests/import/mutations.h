// Random mutations of valid files, for tests of importers.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <random>
#include <string>

#include "base/error.h"
#include "support/stopwatch.h"

namespace troffer::test {

// Returns `text` with one to four changes: bytes replaced, pieces removed, doubled or moved,
// numbers enlarged. Deterministic for a given state of `random`.
inline std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](size_t n) { return n > 0 ? size_t(random()) % n : 0; };
  for (size_t changes = 1 + below(4); changes > 0 && !text.empty(); --changes) {
    const size_t at = below(text.size()), size = below(std::min<size_t>(40, text.size() - at) + 1);
    const std::string piece = text.substr(at, size);
    switch (below(6)) {
      case 0:
        text[at] = char(below(256));
        break;
      case 1:
        text.erase(at, size);
        break;
      case 2:
        text.insert(at, piece);
        break;
      case 3:
        text.insert(below(text.size()), piece);
        break;
      case 4:
        text.insert(at, below(2) == 0 ? "99999999999" : "1e308");
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

// Imports `count` mutations of a file. Each must load or throw an InputError of one line.
inline void check_mutations(const std::string& text, size_t count,
                            const std::function<void(const std::string&)>& import) {
  std::mt19937 random(1);
  size_t loaded = 0, refused = 0;
  const ProcessorStopwatch watch;
  for (size_t i = 0; i < count; ++i) {
    const std::string changed = mutated(text, random);
    CAPTURE(changed);
    try {
      import(changed);
      ++loaded;
    } catch (const InputError& e) {
      ++refused;
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
    }
  }
  CHECK(loaded > 0);
  CHECK(refused > 0);
  CHECK(watch.seconds() < 30);
}

}  // namespace troffer::test
