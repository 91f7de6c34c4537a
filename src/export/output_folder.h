// The files beside a scene's file, in a folder of its name.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace troffer {

class OutputFolder {
 public:
  // Of the scene file `path`: "room.pbrt" -> "room_files". Nothing is made before the first write.
  explicit OutputFolder(const std::string& path);

  // Names are simple. EnvironmentError: what cannot be written.
  void write(const std::string& name, std::span<const uint8_t> bytes);
  // How the scene's file names it.
  std::string relative(const std::string& name) const;

 private:
  std::string folder_, path_;
  bool is_made_ = false;
};

// A name as part of a one-line comment.
std::string printable_comment(std::string_view name);

}  // namespace troffer
