// Input files: whole files in memory, and paths confined to a folder. Importers read through it, so
// that FilesRead knows every file of a scene and KeptFiles can repeat its contents. Errors are
// InputError.
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

// Returns the size of a regular file, bytes. Throws InputError without a line if the file is
// missing, unreadable or not regular (a folder, pipe or device).
uint64_t size_of_file(const std::string& path);

// guess: the file may turn out not to be needed; it is noted in FilesRead when it is.
enum class ReadFor : uint8_t { scene, guess };

// Reads a regular file and decompresses it if its name ends in .gz. Throws InputError as
// size_of_file does, if the contents exceed max_bytes, or if compressed data is broken.
std::vector<uint8_t> read_file(const std::string& path, uint64_t max_bytes = default_max_file_bytes,
                               ReadFor purpose = ReadFor::scene);
std::string read_text_file(const std::string& path, uint64_t max_bytes = default_max_file_bytes);
// Like read_text_file, but also reads pipes and standard input to their end.
std::string read_text_or_pipe(const std::string& path, uint64_t max_bytes);

// Contents of a large file. Reads the same as read_text_file, but in parallel and into
// uninitialised large pages, which matters for files of hundreds of megabytes.
class FileBytes {
 public:
  // Throws InputError as read_file does. Reports progress from 0 to file_progress.
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
  std::string unpacked_;  // contents of a compressed file
};

// Records every file that read_file, read_text_file and FileBytes open while it exists, on any
// thread: the files that a scene consists of. Only one may exist at a time.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;

  std::vector<std::string> paths() const;  // sorted, without duplicates
  // Records a file if a FilesRead exists. The reading functions call it.
  static void note(const std::string& path);

 private:
  mutable std::mutex mutex_;
  std::set<std::string> paths_;
};

// Returns the folder that contains the file; "." for a bare file name.
std::string folder_of(const std::string& path);

// Returns the part after the last dot of the file name, in lower case; "" if there is no dot.
std::string lower_case_ending(const std::string& path);

// Returns the path without a final ".gz".
std::string without_gz(const std::string& path);

// A usable path, or the reason against it, phrased to follow "cannot use 'NAME': ".
struct ConfinedPath {
  std::string path;
  std::string problem;  // empty if the path is usable
  bool is_fine() const { return problem.empty(); }
};

// Returns the path of file `relative` (percent-decoded, '/' between components) inside `folder`. If
// there is no such file, tries the variants of reference_notes.h.
// Rejects an empty name, NUL characters, absolute paths, and paths that leave `folder` by ".." or
// by symbolic links. The file need not exist.
ConfinedPath confined_path(const std::string& folder, std::string_view relative);

// Returns the path of a file in `folder` with the name of `name`, without its folders; "" if there
// is none. For paths that come from another machine.
std::string path_beside(const std::string& folder, const std::string& name);

}  // namespace troffer
