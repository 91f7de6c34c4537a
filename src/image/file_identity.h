// Which file a path stands for, whatever name, link or spelling it is reached by.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace troffer {

struct FileIdentity {
  uint64_t device = 0, number = 0;  // of the file; where it does not exist yet, of its folder
  std::string name;                 // in that folder; empty where the file exists
  bool operator==(const FileIdentity&) const = default;
};

// The file that reading `path` reads. Nothing where there is none, and for character devices
// (/dev/null, a terminal), which are no file that could be lost.
std::optional<FileIdentity> identity_of_input(const std::string& path);

// The file that writing to `path` makes or replaces (AtomicFile). Names in a folder that ignores
// the case of letters are the same in any case. Nothing for character devices, and where the folder
// does not exist. EnvironmentError: as output_target().
std::optional<FileIdentity> identity_of_output(const std::string& path);

// The file that an open descriptor of this process writes to, if it is a regular file.
std::optional<FileIdentity> identity_of_descriptor(int descriptor);

}  // namespace troffer
