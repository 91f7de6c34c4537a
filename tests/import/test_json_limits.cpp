// Tests that JSON that is small in bytes but large in memory is refused before memory is allocated.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include "import/gltf/gltf_json.h"
#include "import/gltf_builder.h"
#include "import/json_limits.h"

using namespace troffer;

namespace test_json_limits {

namespace {

std::string repeated(const std::string& part, size_t count) {
  std::string text;
  text.reserve(part.size() * count);
  for (size_t i = 0; i < count; ++i) text += part;
  return text;
}

// Returns the error message; empty if the text is accepted.
std::string refusal(const std::string& text, const JsonLimits& limits = {}) {
  try {
    const JsonDocument document("a.gltf", text, limits);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

}  // namespace

TEST_CASE("levels: the allowed number and no more, in arrays, objects and both") {
  const JsonLimits limits{4, 100};
  CHECK(refusal("[[[[]]]]", limits).empty());
  CHECK(refusal("[[[[]],[[],[]]]]", limits).empty());
  CHECK(refusal("{\"a\":{\"b\":{\"c\":{}}}}", limits).empty());
  const std::string what = "JSON with more than 4 levels of arrays and objects";
  CHECK(refusal("[[[[[]]]]]", limits) == "a.gltf:1:5: " + what);
  CHECK(refusal("{\"a\":\n {\"b\":[{\"c\":\n  [1]}]}}", limits) == "a.gltf:3:3: " + what);
}

TEST_CASE("values: the allowed number and no more; brackets and commas in strings do not count") {
  const JsonLimits limits{10, 6};
  CHECK(refusal("[1,2,3,4]", limits).empty());
  CHECK(refusal("[\"a,b,c,[{[{[{\\\",,,,,\",2]", limits).empty());
  const std::string what = "JSON with more than 6 values";
  CHECK(refusal("[1,2,3,4,5,6,7,8]", limits) == "a.gltf:1:11: " + what);
  CHECK(refusal("{\"a\":1,\n\"b\":[[],\n[],[]]}", limits) == "a.gltf:3:1: " + what);
  CHECK(refusal("[{},{},{},{}]", limits) == "a.gltf:1:8: " + what);
}

TEST_CASE("ten million open brackets are refused before parsing") {
  const std::string arrays = repeated("[", 10'000'000), objects = repeated("{\"a\":", 2'000'000);
  const double before = peak_memory_mb();
  const std::string what = "JSON with more than 200 levels of arrays and objects";
  CHECK(refusal(arrays) == "a.gltf:1:201: " + what);
  CHECK(refusal(objects) == "a.gltf:1:1001: " + what);
  CHECK(peak_memory_mb() - before < 64);  // a copy of the text, but not its arrays
}

TEST_CASE("too many tiny values take no memory; the allowed number is read") {
  const JsonLimits limits{200, 1'000'000};
  const std::string values = "[" + repeated("{},", 5'000'000) + "{}]";
  const double before = peak_memory_mb();
  CHECK(refusal(values, limits).find("JSON with more than 1000000 values") != std::string::npos);
  CHECK(peak_memory_mb() - before < 64);
  CHECK(refusal("[" + repeated("0,", 900'000) + "0]", limits).empty());
}

TEST_CASE("malformed text is refused as such, even with unclosed strings") {
  for (const char* text : {"\"", "[\"\\", "[\"abc", "]]]]", "}{", ",,,,", ""})
    CHECK(refusal(text, {4, 10}).find("not valid JSON") != std::string::npos);
}

TEST_CASE("a glTF file with too many levels is an error with its place") {
  const InputError e = error_of(gltf_text("'extras':\n" + repeated("[", 300) + repeated("]", 300)));
  CHECK(e.line() == 3);
  CHECK(e.column() == 200);
}

}  // namespace test_json_limits
