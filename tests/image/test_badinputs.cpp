// Broken files: each one gives an InputError or a picture, in bounded time and memory.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.h"
#include "image/atomic_file.h"
#include "image/fixtures.h"
#include "image/read_image.h"
#include "image/write_image.h"
#include "support/stopwatch.h"

using namespace troffer;
using test::TemporaryFolder;

namespace {

const std::string shared = std::string(TROFFER_SOURCE_DIR) + "/../shared/";

enum class Outcome { error, loads, other };

Outcome outcome_of(const std::vector<uint8_t>& bytes, std::string* reason = nullptr) {
  try {
    const Raster raster = decode_raster(bytes, "file");
    const size_t n = size_t(raster.width) * size_t(raster.height) * size_t(raster.channels);
    CHECK(n > 0);
    CHECK(raster.texels8.size() + raster.texels_float.size() == n);
    return Outcome::loads;
  } catch (const InputError& e) {
    if (reason != nullptr) *reason = e.reason();
    return Outcome::error;
  } catch (const std::exception& e) {
    MESSAGE("exception: " << std::string(e.what()));
    return Outcome::other;
  }
}

// Returns the value of "key" in a line of the manifest, which holds one object per line.
std::string field(const std::string& line, const std::string& key) {
  const std::string mark = "\"" + key + "\": \"";
  const size_t begin = line.find(mark);
  if (begin == std::string::npos) return "";
  return line.substr(begin + mark.size(),
                     line.find('"', begin + mark.size()) - begin - mark.size());
}

long peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

std::vector<std::pair<std::string, std::vector<uint8_t>>> small_files() {
  const TemporaryFolder folder;
  std::vector<std::pair<std::string, std::vector<uint8_t>>> files;
  const Image image = test::random_image(12, 10, 7);
  for (const std::string name : {"a.exr", "a.hdr", "a.pfm", "a.png"}) {
    write_image(folder.path(name), image);
    files.emplace_back(name, read_file_bytes(folder.path(name)));
  }
  std::vector<uint8_t> samples;
  Random random(8);
  for (int i = 0; i < 16 * 16 * 3; ++i) samples.push_back(uint8_t(random.next_u32()));
  files.emplace_back("a.jpg", test::make_jpeg(16, 16, 3, samples));
  files.emplace_back("progressive.jpg", test::make_jpeg(16, 16, 3, samples, true));
  return files;
}

}  // namespace

TEST_CASE("broken files behave as the manifest of the collection states") {
  std::ifstream manifest(shared + "badinputs/manifest.json");
  if (!manifest) {
    MESSAGE("skipped: no ../shared/badinputs");
    return;
  }
  const std::set<std::string> formats{"png", "exr", "jpg", "hdr", "pgm", "tga"};
  int files = 0;
  for (std::string line; std::getline(manifest, line);) {
    const std::string format = field(line, "format"), expected = field(line, "expected");
    if (!formats.contains(format)) continue;
    const std::string file = field(line, "file");
    CAPTURE(file);
    const test::ProcessorStopwatch watch;
    std::string reason;
    const Outcome outcome = outcome_of(read_file_bytes(shared + "badinputs/" + file), &reason);
    const double seconds = watch.seconds();
    CAPTURE(reason);
    CHECK(outcome != Outcome::other);
    if (expected == "error" || format == "pgm")
      CHECK(outcome == Outcome::error);
    else if (expected == "loads")
      CHECK(outcome == Outcome::loads);
    CHECK(seconds < 10);
    CHECK(reason.find('\n') == std::string::npos);
    ++files;
  }
  CHECK(files > 300);
  CHECK(peak_memory_mb() < 1024);
}

TEST_CASE("PNGSuite: interlaced files equal their plain counterparts") {
  const std::filesystem::path folder = shared + "badinputs/png/pngsuite";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: no ../shared/badinputs");
    return;
  }
  int pairs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const std::string twin = (folder / ("basi" + name.substr(4))).string();
    if (!name.starts_with("basn") || !std::filesystem::exists(twin)) continue;
    const Image a = read_image(entry.path().string()), b = read_image(twin);
    CAPTURE(name);
    CHECK(a.width == b.width);
    CHECK(a.pixels == b.pixels);
    ++pairs;
  }
  CHECK(pairs > 0);
}

TEST_CASE("no truncated file is accepted as complete") {
  for (const auto& [name, bytes] : small_files()) {
    REQUIRE(outcome_of(bytes) == Outcome::loads);
    for (size_t n = 0; n < bytes.size(); ++n) {
      CAPTURE(name);
      CAPTURE(n);
      CHECK(outcome_of({bytes.begin(), bytes.begin() + std::ptrdiff_t(n)}) == Outcome::error);
    }
  }
}

TEST_CASE("random damage gives an error or a picture") {
  Random random(9);
  for (const auto& [name, bytes] : small_files())
    for (int round = 0; round < 1500; ++round) {
      std::vector<uint8_t> damaged = bytes;
      for (uint32_t n = 1 + random.next_u32() % 4; n > 0; --n) {
        // Half of the changes hit the header.
        const size_t reach =
            random.next_u32() % 2 != 0 ? damaged.size() : std::min<size_t>(damaged.size(), 300);
        damaged[random.next_u64() % reach] = uint8_t(random.next_u32());
      }
      CAPTURE(name);
      CAPTURE(round);
      CHECK(outcome_of(damaged) != Outcome::other);
    }
  CHECK(peak_memory_mb() < 1536);
}

TEST_CASE("the reference pictures have their known means") {
  const auto mean = [](const Image& image) {
    double sum = 0;
    for (const Rgb& p : image.pixels) sum += double(p.r) + double(p.g) + double(p.b);
    return sum / double(3 * image.pixels.size());
  };
  const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/scenes/references/";
  CHECK(mean(read_image(folder + "kj92room_direct.exr")) == doctest::Approx(0.1761).epsilon(3e-4));
  CHECK(mean(read_image(folder + "kj92room_full.exr")) == doctest::Approx(0.3704).epsilon(3e-4));
}
