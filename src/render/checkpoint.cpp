#include "render/checkpoint.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/own_file.h"
#include "image/read_image.h"

namespace troffer {

namespace {

constexpr OwnFile kind{{'t', 'r', 'o', 'f', 'f', 'C', 'h', 'k'}, 2, "checkpoint"};

// The header of the file. Chunks follow, each as its size, its bytes, and a hash of these and of
// the hash before. A chunk of size 0 ends the file.
struct Header {
  char magic[8];
  uint32_t version;
  int32_t part, parts;
  uint32_t unused;
  char program[16];  // version of the program, padded with zeros
  uint64_t settings, scene, preparation;
  uint64_t hash;  // hash of all other fields
};
static_assert(sizeof(Header) == 72);

constexpr size_t most_bytes = size_t(16) << 30;  // safety limit; a film takes at most half of it
constexpr double most_of_interval = 0.1;         // share of the time that writing may take

uint64_t chained(uint64_t before, std::span<const uint8_t> chunk) {
  std::vector<uint8_t> bytes;
  append(bytes, before);
  return hash_of_parts(bytes, chunk);
}

std::string text_of(const char (&program)[16]) {
  return {program, strnlen(program, sizeof(program))};
}

}  // namespace

Checkpoint::Checkpoint(std::string file, PictureKey key, PictureShare share, double interval,
                       Warn warn)
    : file_(std::move(file)),
      key_(std::move(key)),
      share_(share),
      interval_(interval),
      warn_(std::move(warn)),
      next_(Clock::now() + std::chrono::duration_cast<Clock::duration>(interval_)) {}

void Checkpoint::read() {
  bytes_ = read_file_bytes(file_, most_bytes);
  const auto refuse = [&](const std::string& what) { throw InputError(file_, 0, 0, what); };
  std::span<const uint8_t> rest = bytes_;
  const auto h = checked_header<Header>(kind, rest.first(std::min(rest.size(), sizeof(Header))),
                                        file_, [](const Header&, BodySize&) {});
  if (text_of(h.program) != key_.program)
    refuse("checkpoint of troffer " + text_of(h.program) + "; this is " + key_.program);
  if (h.scene != key_.scene) refuse("checkpoint of another scene, or of other light");
  if (h.settings != key_.settings)
    refuse("checkpoint made with other options, or for another camera or other points");
  if (h.preparation != key_.preparation) refuse("checkpoint made with another --solution");
  if (h.part != share_.part || h.parts != share_.parts)
    refuse("checkpoint of --part " + std::to_string(h.part) + "/" + std::to_string(h.parts));
  rest = rest.subspan(sizeof(Header));
  uint64_t hash = h.hash;
  for (uint64_t size = 1; size != 0;) {
    if (rest.size() < 16) refuse("checkpoint is cut short");
    size = ByteReader(rest).next<uint64_t>();
    if (size > rest.size() - 16) refuse("checkpoint is cut short");
    const std::span<const uint8_t> chunk = rest.subspan(8, size);
    rest = rest.subspan(8 + size);
    hash = chained(hash, chunk);
    if (ByteReader(rest).next<uint64_t>() != hash) refuse("checkpoint is damaged");
    rest = rest.subspan(8);
    if (size != 0) chunks_.push_back(chunk);
  }
  if (!rest.empty()) refuse("checkpoint has extra bytes at its end");
}

void Checkpoint::forget_chunks() {
  chunks_ = {};
  bytes_ = {};
}

void Checkpoint::refuse_chunks() const {
  throw InputError(file_, 0, 0, "checkpoint has invalid values");
}

bool Checkpoint::take_turn() {
  if (is_writing_.exchange(true)) return false;
  const bool is_due = Clock::now() >= next_;
  if (!is_due) is_writing_ = false;
  return is_due;
}

void Checkpoint::write_file(const Fill& fill) const {
  Header h{};
  h.part = share_.part;
  h.parts = share_.parts;
  key_.program.copy(h.program, sizeof(h.program) - 1);
  h.settings = key_.settings;
  h.scene = key_.scene;
  h.preparation = key_.preparation;
  const std::vector<uint8_t> header = own_file(kind, h, {});
  AtomicFile file(file_);
  file.write(header);
  uint64_t hash = ByteReader(std::span(header).last(8)).next<uint64_t>();
  std::vector<uint8_t> around;
  const auto add = [&](std::span<const uint8_t> chunk) {
    around.clear();
    append(around, uint64_t(chunk.size()));
    file.write(around);
    file.write(chunk);
    hash = chained(hash, chunk);
    around.clear();
    append(around, hash);
    file.write(around);
  };
  fill(add);
  add({});
  file.commit_to_disk();
}

void Checkpoint::write(const Fill& fill) {
  const Clock::time_point start = Clock::now();
  try {
    write_file(fill);
    failure_.clear();
  } catch (const EnvironmentError& e) {
    failure_ = e.what();
    if (warn_ && warned_.insert(failure_).second) warn_(failure_);
  }
  const Clock::time_point end = Clock::now();
  const std::chrono::duration<double> took = end - start;
  next_ = end + std::chrono::duration_cast<Clock::duration>(
                    std::max(interval_, took * (1 / most_of_interval)));
  is_writing_ = false;
}

}  // namespace troffer
