// References from one file to another: confined to a folder, and tolerant of names from other
// machines.
#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>

#include "import/file.h"
#include "import/reference_notes.h"

namespace troffer {

namespace fs = std::filesystem;

namespace {

char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
}

bool is_same_but_for_case(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower_case(x) == lower_case(y); });
}

bool has_drive(const std::string& name) {
  return name.size() > 1 && name[1] == ':' && lower_case(name[0]) >= 'a' &&
         lower_case(name[0]) <= 'z';
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !fs::is_directory(path, error);
}

// Returns the entry of that name in any case, the alphabetically first if there are several; empty
// if none.
std::string entry_like(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (fs::exists(folder / name, error)) return name;
  std::string best;
  fs::directory_iterator it(folder, error);
  for (; !error && it != fs::directory_iterator(); it.increment(error)) {
    const std::string entry = it->path().filename().string();
    if (is_same_but_for_case(entry, name) && (best.empty() || entry < best)) best = entry;
  }
  return best;
}

// Finds `relative` inside `folder`, ignoring case in each component; empty if there is no such
// file.
std::string found_in_any_case(const fs::path& folder, const fs::path& relative) {
  fs::path at;
  for (const fs::path& part : relative.lexically_normal()) {
    const std::string name = part.string();
    if (name == "." || name.empty()) continue;
    if (name == "..") return "";
    const std::string entry = entry_like(folder / at, name);
    if (entry.empty()) return "";
    at /= entry;
  }
  return is_file(folder / at) ? at.string() : std::string();
}

// Returns the name under which a missing file can be found; empty if there is none.
std::string found_under_other_name(const std::string& folder, const std::string& relative) {
  // pbrt reads \f in "textures\floor.png" as one character.
  constexpr std::string_view escaped = "\n\t\r\b\f", letters = "ntrbf";
  std::string name;
  for (const char c : relative) {
    const size_t escape = escaped.find(c);
    name += c == '\\' || escape != std::string_view::npos ? '/' : c;
    if (escape != std::string_view::npos) name += letters[escape];
  }
  const bool is_elsewhere = has_drive(name) || name.starts_with('/');
  if (has_drive(name)) name.erase(0, 2);
  name.erase(0, std::min(name.find_first_not_of('/'), name.size()));
  while (!name.empty()) {
    std::string found = found_in_any_case(folder, name);
    if (!found.empty() || !is_elsewhere) return found;
    const size_t slash = name.find('/');
    if (slash == std::string::npos) break;
    name.erase(0, slash + 1);
  }
  return "";
}

// Checks the path lexically and, with links resolved, on the disk.
ConfinedPath confined(const std::string& folder, const fs::path& name) {
  if (name.is_absolute()) return {"", "absolute paths are not allowed"};
  const char* const leaves = "it leads out of the scene's folder";
  // The lexical check comes first, so that "x/../../y" is rejected whether or not x exists.
  const fs::path plain = name.lexically_normal();
  if (plain.empty() || *plain.begin() == "..") return {"", leaves};

  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder, error);
  if (error) return {"", "the scene's folder cannot be resolved: " + error.message()};
  const fs::path target = fs::weakly_canonical(root / name, error);
  if (error) return {"", "it cannot be resolved: " + error.message()};
  const auto [in_root, in_target] =
      std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (in_root != root.end()) return {"", leaves};
  return {(fs::path(folder) / name).string(), ""};
}

}  // namespace

thread_local ReferenceNotes* ReferenceNotes::innermost_ = nullptr;

ReferenceNotes::ReferenceNotes() : outer_(innermost_) {
  innermost_ = this;
}

ReferenceNotes::~ReferenceNotes() {
  innermost_ = outer_;
}

void ReferenceNotes::note(const std::string& text) {
  if (innermost_ == nullptr) return;
  std::vector<std::string>& notes = innermost_->notes_;
  if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
}

std::string path_beside(const std::string& folder, const std::string& name) {
  const std::string bare = name.substr(name.find_last_of("/\\:") + 1);
  const ConfinedPath path = confined_path(folder, bare);
  return path.is_fine() && is_file(path.path) ? path.path : std::string();
}

ConfinedPath confined_path(const std::string& folder, std::string_view relative) {
  if (relative.empty()) return {"", "it is empty"};
  if (relative.find('\0') != std::string_view::npos) return {"", "it has a NUL character"};
  const std::string name(relative);
  const ConfinedPath asked = confined(folder, name);
  if (asked.is_fine() && is_file(asked.path)) return asked;
  if (fs::path(name).is_absolute()) return asked;
  const std::string other = found_under_other_name(folder, name);
  if (other.empty()) return asked;
  const ConfinedPath found = confined(folder, other);
  if (!found.is_fine()) return asked;
  ReferenceNotes::note("'" + name.substr(0, 200) + "' is read from '" + other.substr(0, 200) + "'");
  return found;
}

}  // namespace troffer
