// Results of an interrupted run. A file that stood at an output before may be more complete than
// what the run has made, so it stays, and the unfinished result goes beside it.
#pragma once

#include <string>
#include <vector>

namespace troffer {

// Where an unfinished result for the output `path` may be written: `path` itself where no file is
// there, and where it is a pipe or a device; else the first free name of FILE.partial.ENDING,
// FILE.partial2.ENDING and so on. is_kept: a checkpoint holds the same work, so one file beside the
// output is enough; empty where there is one already.
std::string place_for_unfinished(const std::string& path, bool is_kept = false);

// Collects where unfinished results went, for the line that says so.
class Unfinished {
 public:
  // The output `path` was written to `place`; an empty place: not at all.
  void note(const std::string& path, const std::string& place);
  // note() with place_for_unfinished(), which is returned.
  std::string place(const std::string& path);
  // "wrote a.exr and b.partial.exr; b.exr stays as before", or "nothing was written".
  std::string text() const;

 private:
  std::vector<std::string> written_, kept_;
};

}  // namespace troffer
