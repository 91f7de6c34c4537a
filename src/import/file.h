// Files that scenes are made of: whole files in memory, and paths that stay inside a folder.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "import/read_progress.h"

namespace troffer {

constexpr uint64_t default_max_file_bytes = uint64_t(4) << 30;

// Bytes of a regular file. InputError (line and column 0) where it is missing, unreadable or not a
// regular file (a folder, a pipe, a device).
uint64_t size_of_file(const std::string& path);

// guess: it may not be needed; FilesRead is told when it is.
enum class ReadFor : uint8_t { scene, guess };

// Contents of a regular file; of one whose name ends in .gz, decompressed. InputError as above,
// where it is, or becomes, larger than max_bytes, and where compressed data is broken.
std::vector<uint8_t> read_file(const std::string& path, uint64_t max_bytes = default_max_file_bytes,
                               ReadFor purpose = ReadFor::scene);
std::string read_text_file(const std::string& path, uint64_t max_bytes = default_max_file_bytes);

// The contents of a file, as they are: what read_text_file reads, on all cores and into pages that
// are not cleared before. For files of many million numbers.
class FileBytes {
 public:
  // InputError: as read_file. Tells the first file_progress of the whole.
  explicit FileBytes(const std::string& path, uint64_t max_bytes = default_max_file_bytes,
                     const TellProgress& progress = {});
  std::string_view view() const {
    return bytes_ ? std::string_view(bytes_.get(), size_) : std::string_view(unpacked_);
  }

 private:
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<char[], Free> bytes_;
  size_t size_ = 0;
  std::string unpacked_;  // of compressed files
};

// Names every file that read_file and read_text_file open while it lives, on whatever thread: what
// a scene was made of. One at a time.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;

  std::vector<std::string> paths() const;  // sorted, each once
  // What read_file and read_text_file do, whether or not anybody asks.
  static void note(const std::string& path);

 private:
  mutable std::mutex mutex_;
  std::set<std::string> paths_;
};

// The folder a path's file lies in, "." for a bare file name.
std::string folder_of(const std::string& path);

// The part after the last dot of the last path component, in lower case; "" where there is none.
std::string lower_case_ending(const std::string& path);

// The path without ".gz" at its end.
std::string without_gz(const std::string& path);

// `path`, or the reason why it may not be used, in words that finish "cannot use 'NAME': …".
struct ConfinedPath {
  std::string path;
  std::string problem;  // empty = fine
  bool is_fine() const { return problem.empty(); }
};

// The path of file `relative` (already percent-decoded, '/' between components) inside `folder`.
// Refused: an empty name, NUL characters, absolute paths, and whatever ends outside `folder` by
// ".." or by symbolic links. Whether the file exists is not looked at.
ConfinedPath confined_path(const std::string& folder, std::string_view relative);

// Of a name that cannot be used as it is (it comes from another machine): the path of the file of
// that name, without its folders, in `folder`; "" where there is none.
std::string path_beside(const std::string& folder, const std::string& name);

}  // namespace troffer
