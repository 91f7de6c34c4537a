// Refuses outputs that would replace an input of the same command, or each other, before any work
// is done. Files are compared by identity, not by name (image/file_identity.h). All commands that
// write files use it.
#pragma once

#include <string>
#include <vector>

#include "image/file_identity.h"
#include "import/file.h"
#include "lighting/daylight_options.h"

namespace troffer {

struct SceneChoice;

// Collects the inputs and outputs of a command.
class OutputGuard {
 public:
  // The files behind standard output and standard error count as outputs.
  OutputGuard();

  // `role` names a file in messages: "-o", "--stats", "the scene". Empty paths are ignored. All
  // throw UsageError if an output is also an input or another output.
  void add_input(const std::string& role, const std::string& path);
  void add_output(const std::string& role, const std::string& path);
  void add_outputs(const std::string& role, const std::vector<std::string>& paths);
  // Adds the files that these options name.
  void add_inputs(const SceneChoice& scene, const DaylightOptions& daylight);

  // Checks all files that were read. Call it after the scene is loaded: images, meshes and included
  // files are known then.
  void check_files_read() const;
  const FilesRead& files_read() const { return read_; }

 private:
  struct Named {
    std::string role, path;
    FileIdentity identity;
    bool is_stream = false;  // an open file of this process
  };
  static void check(const Named& output, const Named& input);

  FilesRead read_;
  std::vector<Named> inputs_, outputs_;
};

}  // namespace troffer
