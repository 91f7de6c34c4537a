#include "export/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/random.h"
#include "image/atomic_file.h"

namespace troffer {

namespace fs = std::filesystem;

namespace {

// limit on the size of a scene file that is read back
constexpr uintmax_t most_read = uintmax_t(256) << 20;

// Replaces quotes and line ends, which would break the scene file.
std::string plain(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32 || c == '"' || c == '\\') c = '_';
  return name;
}

std::string content_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(text).str();
}

bool has_bytes(const fs::path& file, std::span<const uint8_t> bytes) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) != bytes.size()) return false;
  const std::string content = content_of(file);
  return content.size() == bytes.size() &&
         std::equal(bytes.begin(), bytes.end(), content.begin(),
                    [](uint8_t a, char b) { return a == uint8_t(b); });
}

uint64_t hash_bytes(std::span<const uint8_t> bytes) {
  uint64_t hash = bytes.size(), word = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    word = word << 8 | bytes[i];
    if (i % 8 == 7) hash = hash_combine(hash, word);
  }
  return hash_combine(hash, word);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path)
    : main_(path),
      folder_(plain(fs::path(path).stem().string()) + "_files"),
      path_((fs::path(path).parent_path() / folder_).string()) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  // A larger file is not read, and its old data files are not removed. They keep their names
  // anyway.
  if (fs::file_size(path, error) <= most_read) before_ = content_of(path);
}

OutputFolder::~OutputFolder() {
  if (is_finished_) return;
  std::error_code ignored;  // another error is already being reported
  for (const Written& w : written_) fs::remove(w.file, ignored);
  if (is_new_) fs::remove(path_, ignored);  // fails if it is not empty
}

void OutputFolder::make_folder() {
  if (is_made_) return;
  std::error_code error;
  is_new_ = !fs::exists(path_, error);
  fs::create_directories(path_, error);
  if (error) throw EnvironmentError("cannot make the folder " + path_ + ": " + error.message());
  is_made_ = true;
}

bool OutputFolder::is_mentioned(const std::string& name) const {
  const std::string reference = folder_ + "/" + name;
  return before_.find(reference) != std::string::npos ||
         before_.find(uri_of(reference)) != std::string::npos;
}

bool OutputFolder::is_free(const std::string& name) const {
  std::error_code error;
  return !names_.contains(name) && !fs::exists(fs::path(path_) / name, error) &&
         !is_mentioned(name);
}

std::string OutputFolder::write(const std::string& name, std::span<const uint8_t> bytes) {
  make_folder();
  const fs::path parts(name);
  const std::string stem = parts.stem().string(), ending = parts.extension().string();
  const auto hash = uint32_t(hash_bytes(bytes));
  std::string chosen = name;
  for (int i = 0;; ++i) {
    if (!names_.contains(chosen) && has_bytes(fs::path(path_) / chosen, bytes)) {
      names_.insert(chosen);
      return folder_ + "/" + chosen;
    }
    if (is_free(chosen)) break;
    chosen = i == 0 ? fmt::format("{}-{:08x}{}", stem, hash, ending)
                    : fmt::format("{}-{:08x}-{}{}", stem, hash, i, ending);
  }
  const std::string file = (fs::path(path_) / chosen).string();
  TemporaryFile cleaner(file);
  AtomicFile out(file);
  out.write(bytes);
  out.commit();
  names_.insert(chosen);
  written_.push_back({file, std::move(cleaner)});
  return folder_ + "/" + chosen;
}

void OutputFolder::finish(std::span<const uint8_t> bytes) {
  AtomicFile file(main_);
  file.write(bytes);
  file.commit();
  is_finished_ = true;
  for (Written& w : written_) w.cleaner.forget();
  remove_replaced();
}

void OutputFolder::finish(std::string_view text) {
  finish(std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

void OutputFolder::remove_replaced() const {
  if (before_.empty()) return;
  std::error_code ignored;
  std::vector<fs::path> replaced;
  for (const auto& entry : fs::directory_iterator(path_, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file(ignored) && !names_.contains(name) && is_mentioned(name))
      replaced.push_back(entry.path());
  }
  for (const fs::path& file : replaced) fs::remove(file, ignored);
}

void OutputFolder::link(const std::string& name, const std::string& reference) const {
  const fs::path target = fs::path(path_).parent_path() / reference, file = fs::path(path_) / name;
  if (target == file) return;
  std::error_code error;
  const fs::path temporary = file.string() + ".tmp";
  fs::remove(temporary, error);
  fs::create_hard_link(target, temporary, error);
  if (error) {
    error.clear();
    fs::copy_file(target, temporary, error);
  }
  if (!error) fs::rename(temporary, file, error);
  if (error) throw EnvironmentError("cannot write " + file.string() + ": " + error.message());
}

std::string uri_of(const std::string& path) {
  std::string uri;
  for (const char c : path) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || c == '/' || c == '_' || c == '.' || c == '-';
    uri += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

std::string printable_comment(std::string_view name) {
  return plain(std::string(name.substr(0, 200)));
}

}  // namespace troffer
