#include "import/file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <system_error>

#include "base/error.h"
#include "base/parallel.h"
#include "base/similar_file.h"
#include "import/kept_files.h"

namespace troffer {

namespace fs = std::filesystem;

namespace {

std::atomic<FilesRead*> asked{nullptr};

}  // namespace

FilesRead::FilesRead() {
  FilesRead* none = nullptr;
  TROFFER_CHECK(asked.compare_exchange_strong(none, this));
}

FilesRead::~FilesRead() {
  asked = nullptr;
}

std::vector<std::string> FilesRead::paths() const {
  const std::lock_guard lock(mutex_);
  return {paths_.begin(), paths_.end()};
}

void FilesRead::note(const std::string& path) {
  FilesRead* files = asked;
  if (files == nullptr) return;
  const std::lock_guard lock(files->mutex_);
  files->paths_.insert(path);
}

namespace {

uint64_t allowed_size(const std::string& path, uint64_t max_bytes) {
  const uint64_t size = size_of_file(path);
  if (size > max_bytes)
    throw InputError(path, 0, 0,
                     "has " + std::to_string(size) + " bytes; at most " +
                         std::to_string(max_bytes) + " are read");
  return size;
}

template <class Bytes>
Bytes read_whole(const std::string& path, uint64_t max_bytes, ReadFor purpose) {
  if (const KeptFiles::Bytes kept = KeptFiles::find(path)) return Bytes(kept->begin(), kept->end());
  const uint64_t size = allowed_size(path, max_bytes);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, 0, 0, std::string("cannot be opened: ") + std::strerror(errno));
  if (purpose == ReadFor::scene) FilesRead::note(path);
  Bytes bytes(size_t(size), {});
  in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
  // A file that has shrunk meanwhile is short here; its parser reports it.
  if (in.bad()) throw InputError(path, 0, 0, "cannot be read");
  bytes.resize(size_t(in.gcount()));
  KeptFiles::keep(path, bytes.data(), bytes.size());
  return bytes;
}

// Allocates memory in pages of 2 MiB if possible: faults of 4 KiB pages would take longer than
// reading.
char* large_pages(size_t size) {
  constexpr size_t page = size_t(2) << 20;
  if (size > std::numeric_limits<size_t>::max() - page) throw std::bad_alloc();
  const size_t whole = (size / page + 1) * page;
  void* const bytes = std::aligned_alloc(page, whole);
  if (bytes == nullptr) throw std::bad_alloc();
  madvise(bytes, whole, MADV_HUGEPAGE);  // only a hint, so the result is ignored
  return static_cast<char*>(bytes);
}

// Reads bytes [begin, end) of an open file. Returns their number, or -1.
int64_t read_part(int file, char* bytes, size_t begin, size_t end) {
  size_t at = begin;
  while (at < end) {
    const ssize_t n = pread(file, bytes + at, end - at, off_t(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return -1;
    if (n == 0) break;
    at += size_t(n);
  }
  return int64_t(at - begin);
}

// Limits on decompression. Text and numbers shrink to about a tenth; decompression bombs shrink to
// a thousandth.
constexpr uint64_t always_unpacked = uint64_t(1) << 28, max_gzip_ratio = 200;

// Decompresses the contents of a file whose name ends in .gz; returns others unchanged. Memory
// grows with the output, so a false length in the file costs nothing.
template <class Bytes>
Bytes unpacked(const std::string& path, Bytes packed, uint64_t max_bytes) {
  if (lower_case_ending(path) != "gz") return packed;
  const auto fail = [&](const std::string& what) { throw InputError(path, 0, 0, what); };
  constexpr int any_gzip = 15 + 16;  // the largest window, with a gzip header
  z_stream stream{};
  if (inflateInit2(&stream, any_gzip) != Z_OK) fail("cannot start to decompress");
  max_bytes = std::min(max_bytes, std::max(always_unpacked, packed.size() * max_gzip_ratio));
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&stream, inflateEnd);
  Bytes out;
  std::vector<unsigned char> block(size_t(1) << 18);
  size_t at = 0;
  int status = Z_OK;
  while (status != Z_STREAM_END || at < packed.size() || stream.avail_in > 0) {
    if (stream.avail_in == 0) {
      const size_t n = std::min(packed.size() - at, size_t(1) << 30);
      if (n == 0) fail("the compressed data ends early");
      stream.next_in = reinterpret_cast<unsigned char*>(packed.data()) + at;
      stream.avail_in = uInt(n);
      at += n;
    }
    if (status == Z_STREAM_END && inflateReset(&stream) != Z_OK) fail("cannot be decompressed");
    stream.next_out = block.data();
    stream.avail_out = uInt(block.size());
    status = inflate(&stream, Z_NO_FLUSH);
    const size_t made = block.size() - stream.avail_out;
    if (made > max_bytes - out.size())
      fail("decompresses to more than " + std::to_string(max_bytes) + " bytes");
    out.insert(out.end(), block.begin(), block.begin() + std::ptrdiff_t(made));
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
      fail("the compressed data is broken");
  }
  return out;
}

}  // namespace

uint64_t size_of_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(path, -1, -1, "no such file" + did_you_mean_file(path));
  if (error) throw InputError(path, 0, 0, "cannot be read: " + error.message());
  if (status.type() == fs::file_type::directory)
    throw InputError(path, 0, 0, "is a folder, not a file");
  if (status.type() != fs::file_type::regular)
    throw InputError(path, 0, 0, "is not a regular file");
  const uint64_t size = fs::file_size(path, error);
  if (error) throw InputError(path, 0, 0, "cannot be read: " + error.message());
  return size;
}

std::vector<uint8_t> read_file(const std::string& path, uint64_t max_bytes, ReadFor purpose) {
  return unpacked(path, read_whole<std::vector<uint8_t>>(path, max_bytes, purpose), max_bytes);
}

std::string read_text_or_pipe(const std::string& path, uint64_t max_bytes) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type != fs::file_type::fifo && type != fs::file_type::character)
    return read_text_file(path, max_bytes);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, 0, 0, std::string("cannot be opened: ") + std::strerror(errno));
  std::string text, block(size_t(1) << 16, '\0');
  while (in.read(block.data(), std::streamsize(block.size())), in.gcount() > 0) {
    text.append(block, 0, size_t(in.gcount()));
    if (text.size() > max_bytes)
      throw InputError(path, 0, 0, "has more than " + std::to_string(max_bytes) + " bytes");
  }
  if (in.bad()) throw InputError(path, 0, 0, "cannot be read");
  return text;
}

std::string read_text_file(const std::string& path, uint64_t max_bytes) {
  return unpacked(path, read_whole<std::string>(path, max_bytes, ReadFor::scene), max_bytes);
}

FileBytes::FileBytes(const std::string& path, uint64_t max_bytes, const TellProgress& tell) {
  if (lower_case_ending(path) == "gz") {
    unpacked_ = read_text_file(path, max_bytes);
    return;
  }
  const auto size = size_t(allowed_size(path, max_bytes));
  bytes_.reset(large_pages(size));
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw InputError(path, 0, 0, std::string("cannot be opened: ") + strerror(errno));
  FilesRead::note(path);
  constexpr size_t piece = size_t(4) << 20;
  std::vector<int64_t> had(size / piece + 1, 0);
  ReadProgress progress(tell, 0, file_progress, size);
  parallel_pieces(size, piece, [&](size_t begin, size_t end) {
    had[begin / piece] = read_part(file, bytes_.get(), begin, end);
    progress.add(end - begin);
  });
  close(file);
  // A file that has shrunk meanwhile is short here; its parser reports it.
  for (size_t i = 0; i < had.size(); ++i) {
    if (had[i] < 0) throw InputError(path, 0, 0, "cannot be read");
    size_ += size_t(had[i]);
    if (had[i] < int64_t(piece)) break;
  }
}

std::string without_gz(const std::string& path) {
  return lower_case_ending(path) == "gz" ? path.substr(0, path.size() - 3) : path;
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string lower_case_ending(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  const size_t dot = name.rfind('.');
  if (dot == std::string::npos) return "";
  std::string ending = name.substr(dot + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return ending;
}

}  // namespace troffer
