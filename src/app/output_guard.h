// Refuses outputs that would replace an input of the same command, or each other, before any work
// is done. Files are compared by what they are, not by their names (image/file_identity.h).
#pragma once

#include <string>
#include <vector>

#include "image/file_identity.h"
#include "import/file.h"
#include "lighting/daylight_options.h"

namespace troffer {

struct SceneChoice;

class OutputGuard {
 public:
  // Files to which standard output and standard error go count as outputs.
  OutputGuard();

  // `role` names a file in messages: "-o", "--stats", "the scene". An empty path is none. All throw
  // UsageError where an output is an input or another output.
  void add_input(const std::string& role, const std::string& path);
  void add_output(const std::string& role, const std::string& path);
  void add_outputs(const std::string& role, const std::vector<std::string>& paths);
  // The files that these options name.
  void add_inputs(const SceneChoice& scene, const DaylightOptions& daylight);

  // Call once the scene is read: images, meshes and included files are known then.
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
