// A failed TROFFER_CHECK names the pixel and the sample.
#include <doctest/doctest.h>

#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "support/abort_message.h"

using namespace troffer;
using troffer::test::abort_message;

namespace {

std::string name_of(const void* batch, size_t i) {
  const auto& samples = *static_cast<const std::vector<int>*>(batch);
  return "pixel (" + std::to_string(i) + ",7), sample " + std::to_string(samples[i]);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::vector<int> samples{40, 50, 60};

}  // namespace

TEST_CASE("a failed CHECK prints the condition, the item and the command") {
  const std::string message = abort_message([] {
    set_check_command("troffer render room.pbrt");
    const CheckContext context(&samples, samples.size(), name_of);
    CheckItems items;
    for (size_t i = 0; i < samples.size(); ++i) {
      items.at(i);
      TROFFER_CHECK(samples[i] != 50);
    }
  });
  CHECK(contains(message, "test_check.cpp"));
  CHECK(contains(message, "CHECK(samples[i] != 50) failed"));
  CHECK(contains(message, "at pixel (1,7), sample 50\n"));
  CHECK(contains(message, "reproduce with: troffer render room.pbrt"));
}

TEST_CASE("a CHECK that holds does nothing; without a context the message has no place") {
  CHECK(abort_message([] { TROFFER_CHECK(samples.size() == 3); }).empty());
  const std::string message = abort_message([] { TROFFER_CHECK(samples.empty()); });
  CHECK(contains(message, "failed"));
  CHECK_FALSE(contains(message, " at "));
}

TEST_CASE("the place in a message follows batches, loops and threads") {
  CHECK(check_place().empty());
  {
    const CheckContext context(&samples, samples.size(), name_of);
    // outside a loop over items: the first and the last
    CHECK(check_place() == "one from pixel (0,7), sample 40 to pixel (2,7), sample 60");
    {
      CheckItems items;
      items.at(2);
      CHECK(check_place() == "pixel (2,7), sample 60");
      {
        const std::vector<int> others{8};
        const CheckContext inner(&others, 1, name_of);
        CHECK(check_place() == "pixel (0,7), sample 8");
      }
      CHECK(check_place() == "pixel (2,7), sample 60");
      {
        const CheckPart part(1);
        items.at(0);
        CHECK(check_place() == "pixel (1,7), sample 50");
        const CheckPart part_of_part(1);
        CHECK(check_place() == "pixel (2,7), sample 60");
        const CheckContext inner(&samples, samples.size(), name_of);
        items.at(1);
        CHECK(check_place() == "pixel (1,7), sample 50");
      }
      CHECK(check_place() == "pixel (0,7), sample 40");
      std::string elsewhere = "?";
      std::thread([&] { elsewhere = check_place(); }).join();
      CHECK(elsewhere.empty());
    }
    CHECK(contains(check_place(), "one from"));
    const CheckContext empty(&samples, 0, name_of);
    CHECK(check_place().empty());
  }
  CHECK(check_place().empty());
}
