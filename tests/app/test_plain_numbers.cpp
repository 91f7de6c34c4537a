// Numbers on the command line: nothing wraps around, changes its base, or is cut off.
#include <doctest/doctest.h>

#include <string>

#include "app/plain_numbers.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_plain_numbers {

namespace {

// Returns the normalized text, or "!" and the reason if it is refused.
std::string read(NumberKind kind, std::string text) {
  const auto wrong = check_number(kind, text);
  return wrong ? "!" + *wrong : text;
}

bool is_refused(NumberKind kind, const std::string& text) {
  return read(kind, text)[0] == '!';
}

}  // namespace

TEST_CASE("whole numbers are decimal and in range") {
  for (const NumberKind kind : {NumberKind::natural, NumberKind::integer}) {
    CHECK(read(kind, "0") == "0");
    CHECK(read(kind, "010") == "10");  // not octal
    CHECK(read(kind, "+7") == "7");
    CHECK(read(kind, "000") == "0");
    CHECK(read(kind, "9223372036854775807") == "9223372036854775807");
    for (const char* text : {"", " 5", "5 ", "0x10", "1e3", "1.0", "nan", "5x", "--5", "+-5", "-",
                             "+", "99999999999999999999", "-99999999999999999999", "\xc2\xbd"})
      CHECK(is_refused(kind, text));
  }
  CHECK(read(NumberKind::natural, "18446744073709551615") == "18446744073709551615");
  CHECK(is_refused(NumberKind::natural, "18446744073709551616"));
  CHECK(read(NumberKind::natural, "-1") == "!'-1' is below 0");
  CHECK(read(NumberKind::integer, "-007") == "-7");
}

TEST_CASE("real numbers are decimal and finite; a decimal comma is reported") {
  for (const char* text : {"1.5", "-1e-3", ".5", "5.", "1E3"})
    CHECK(read(NumberKind::real, text) == text);
  for (const char* text : {"", " 1", "1 ", "nan", "inf", "-inf", "infinity", "0x1p3", "1e999", "1f",
                           "1.5.2", "+-1", "e5"})
    CHECK(is_refused(NumberKind::real, text));
  CHECK(read(NumberKind::real, "1,5") == "!'1,5' has a comma: write 1.5");
}

TEST_CASE("all commands refuse numbers that would overflow and words that are not numbers") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), out = folder.path("o.exr");
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n");
  const std::vector<std::vector<std::string>> commands{
      {"render", scene, "-o", out},
      {"measure", scene, "--points", points},
      {"radiosity", scene, "-o", folder.path("a.trad")},
      {"bake", scene, "-o", folder.path("b.glb")},
      {"report", scene, "-o", folder.path("report")},
      {"view", scene}};
  for (const auto& command : commands)
    for (const char* text : {"-1", "0x10", "99999999999999999999", "nan", "1.5", " 3", "3 ", ""}) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"--seed", text});
      const Finished f = run_program(folder, words);
      CAPTURE(f.err);
      CAPTURE(command[0]);
      CHECK(f.status == 2);
      CHECK(f.err.find("--seed") != std::string::npos);
    }
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"--fov", "nan"},  {"--fov", "0x40"},         {"--error", "1e-2x"}, {"--spp", "0x4"},
      {"--spp", "-4"},   {"--spp", "4294967300"},   {"--threads", "1e0"}, {"--north", "inf"},
      {"--ground", "+"}, {"--time-limit", "1e999"}, {"--max-spp", "4.0"}, {"--depth", "-1"}};
  for (const auto& [option, text] : wrong) {
    const Finished f = run_program(folder, {"render", scene, "-o", out, option, text});
    CAPTURE(option);
    CAPTURE(f.err);
    CHECK(f.status == 2);
    CHECK(f.error_lines().size() == 1);
  }
}

}  // namespace test_plain_numbers
