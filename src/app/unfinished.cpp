#include "app/unfinished.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/progress.h"
#include "image/output_target.h"

namespace troffer {

namespace fs = std::filesystem;

namespace {

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type() != fs::file_type::not_found;
}

}  // namespace

std::string place_for_unfinished(const std::string& path, bool is_kept) {
  const OutputTarget target = output_target(path);
  if (target.kind != OutputTarget::Kind::file || !is_there(target.path)) return path;
  const fs::path whole(path);
  const std::string stem = (whole.parent_path() / whole.stem()).string(),
                    ending = whole.extension().string();
  for (int n = 1;; ++n) {
    std::string place = stem + ".partial" + (n == 1 ? "" : std::to_string(n)) + ending;
    if (!is_there(place)) return place;
    if (is_kept) return {};
  }
}

void Unfinished::note(const std::string& path, const std::string& place) {
  if (!place.empty()) written_.push_back(place);
  if (place != path && is_there(path)) kept_.push_back(path);
}

std::string Unfinished::place(const std::string& path) {
  std::string place = place_for_unfinished(path);
  note(path, place);
  return place;
}

std::string Unfinished::text() const {
  std::string text = written_.empty() ? "nothing was written" : "wrote " + listed(written_);
  if (!kept_.empty())
    text += fmt::format("; {} {} as before", listed(kept_), kept_.size() == 1 ? "stays" : "stay");
  return text;
}

}  // namespace troffer
