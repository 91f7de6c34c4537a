// Places the results of an interrupted run. An existing output may be more complete than the
// interrupted result, so it stays, and the result goes next to it.
#pragma once

#include <string>
#include <vector>

namespace troffer {

// Returns the file for an unfinished result of the output `path`: `path` itself if it does not
// exist, or if it is a pipe or device. Otherwise the first free name of FILE.partial.ENDING,
// FILE.partial2.ENDING and so on. is_kept: a checkpoint holds the same work, so one file next to
// the output suffices; returns an empty text if there is one.
std::string place_for_unfinished(const std::string& path, bool is_kept = false);

// Collects where unfinished results were written, for the final message.
class Unfinished {
 public:
  // Records that the output `path` was written to `place`; empty: not written.
  void note(const std::string& path, const std::string& place);
  // Calls note() with place_for_unfinished(), and returns that place.
  std::string place(const std::string& path);
  // Returns "wrote a.exr and b.partial.exr; b.exr stays as before", or "nothing was written".
  std::string text() const;

 private:
  std::vector<std::string> written_, kept_;
};

}  // namespace troffer
