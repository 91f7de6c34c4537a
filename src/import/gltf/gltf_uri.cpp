#include "import/gltf/gltf_uri.h"

#include "base/error.h"
#include "import/file.h"
#include "import/uri.h"

namespace troffer {

std::string path_of_uri(const JsonNode& uri, const std::string& folder) {
  const std::string& text = uri.as_string();
  const std::string quoted = "'" + printable(text) + "'";
  const bool has_drive = text.size() > 1 && text[1] == ':';  // drive letter of a Windows path
  if (has_uri_scheme(text) && !has_drive)
    uri.fail(quoted + ": only files in the scene's folder and data URIs are read");
  const auto name = percent_decoded(text);
  if (!name) uri.fail(quoted + ": a '%' is not followed by two hexadecimal digits");
  const ConfinedPath path = confined_path(folder, *name);
  if (!path.is_fine()) uri.fail(quoted + " cannot be used: " + path.problem);
  return path.path;
}

std::vector<uint8_t> read_file_of_uri(const JsonNode& uri, const std::string& path) {
  try {
    return read_file(path);
  } catch (const InputError& e) {
    uri.fail("'" + printable(uri.as_string()) + "': " + e.reason());
  }
}

}  // namespace troffer
