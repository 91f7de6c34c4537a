// A scene's file and the files beside it, in a folder of its name, as one output.
//
// Files in the folder get names that the scene's file, as it was before, does not mention, and the
// scene's file comes last. So whoever is stopped at any moment leaves the old file with its old
// data, or the new one with its own.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/temporary_files.h"

namespace troffer {

class OutputFolder {
 public:
  // Of the scene file `path`: "room.pbrt" -> "room_files". Nothing is made before the first write.
  explicit OutputFolder(const std::string& path);
  // Removes what was written where finish() was not reached.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Writes a file of that (simple) name, or where the name is taken by other bytes, of a similar
  // one. Returns how the scene's file names it. EnvironmentError: what cannot be written.
  std::string write(const std::string& name, std::span<const uint8_t> bytes);
  // Writes the scene's file itself, and removes files of the folder that it alone mentioned before
  // and mentions no more.
  void finish(std::span<const uint8_t> bytes);
  void finish(std::string_view text);

  // After finish(): makes `name` too stand for what write() returned as `reference`.
  void link(const std::string& name, const std::string& reference) const;

 private:
  struct Written {
    std::string file;
    TemporaryFile cleaner;  // until finish()
  };

  std::string main_, folder_, path_;
  std::string before_;  // the scene's file as it was
  bool is_made_ = false, is_new_ = false, is_finished_ = false;
  std::vector<Written> written_;
  std::set<std::string> names_;  // in use by what is written

  void make_folder();
  bool is_mentioned(const std::string& name) const;
  bool is_free(const std::string& name) const;
  void remove_replaced() const;
};

// A relative path as a URI reference: what is not plain is percent-encoded.
std::string uri_of(const std::string& path);

// A name as part of a one-line comment.
std::string printable_comment(std::string_view name);

}  // namespace troffer
