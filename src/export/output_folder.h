// A scene file and its data files, in a folder of the same name, as one output. Both exporters use
// it.
//
// Data files get names that the previous scene file does not mention, and the scene file is written
// last. An interruption at any moment leaves either the old scene with its data or the new one with
// its data.
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
  // Folder of the scene file `path`: "room.pbrt" -> "room_files". It is created at the first write.
  explicit OutputFolder(const std::string& path);
  // Removes the written files unless finish() completed.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Writes a file of this simple name, or a similar one if another file has the name. Returns the
  // name by which the scene file refers to it. Throws EnvironmentError if it cannot be written.
  std::string write(const std::string& name, std::span<const uint8_t> bytes);
  // Writes the scene file, and removes files in the folder that only its previous version
  // mentioned.
  void finish(std::span<const uint8_t> bytes);
  void finish(std::string_view text);

  // After finish(): makes `name` another name of the file that write() returned as `reference`.
  void link(const std::string& name, const std::string& reference) const;

 private:
  struct Written {
    std::string file;
    TemporaryFile cleaner;  // until finish()
  };

  std::string main_, folder_, path_;
  std::string before_;  // previous content of the scene file
  bool is_made_ = false, is_new_ = false, is_finished_ = false;
  std::vector<Written> written_;
  std::set<std::string> names_;  // used by written files

  void make_folder();
  bool is_mentioned(const std::string& name) const;
  bool is_free(const std::string& name) const;
  void remove_replaced() const;
};

// Returns a relative path as a URI reference; special characters are percent-encoded.
std::string uri_of(const std::string& path);

// Returns a name as part of a one-line comment.
std::string printable_comment(std::string_view name);

}  // namespace troffer
