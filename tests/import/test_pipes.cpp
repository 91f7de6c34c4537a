// Lists that come from a pipe.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include "base/error.h"
#include "import/file.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pipes {

TEST_CASE("a list is read from a pipe to its end, and not beyond a limit") {
  std::signal(SIGPIPE, SIG_IGN);  // the reader closes early
  const TempFolder folder;
  const std::string pipe = folder.write("pipe", "");
  std::remove(pipe.c_str());
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const std::string text = "x,y,z,nx,ny,nz\n" + std::string(200'000, '1') + "\n";
  for (const uint64_t limit : {uint64_t(1) << 20, uint64_t(1000)}) {
    std::thread writer([&] { std::ofstream(pipe) << text; });
    if (limit > text.size())
      CHECK(read_text_or_pipe(pipe, limit) == text);
    else
      CHECK_THROWS_AS(read_text_or_pipe(pipe, limit), InputError);
    writer.join();
  }
  CHECK_THROWS_AS(read_text_file(pipe), InputError);
}

}  // namespace test_pipes
