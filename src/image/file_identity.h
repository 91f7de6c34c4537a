// Identity of the file that a path refers to, independent of its name, links or spelling. The
// output guard (app/output_guard.h) uses it to prevent a command from overwriting its own inputs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace troffer {

struct FileIdentity {
  uint64_t device = 0, number = 0;  // those of the file, or of its folder if it does not exist
  std::string name;                 // name in that folder; empty if the file exists
  bool operator==(const FileIdentity&) const = default;
};

// Returns the file that reading `path` reads. Empty if there is none, and for character devices
// (/dev/null, a terminal), whose content cannot be lost.
std::optional<FileIdentity> identity_of_input(const std::string& path);

// Returns the file that writing to `path` creates or replaces (AtomicFile). In folders that ignore
// case, names are compared without it. Empty for character devices and if the folder does not
// exist. Throws EnvironmentError like output_target().
std::optional<FileIdentity> identity_of_output(const std::string& path);

// Returns the regular file that an open descriptor of this process refers to, if it is one.
std::optional<FileIdentity> identity_of_descriptor(int descriptor);

}  // namespace troffer
