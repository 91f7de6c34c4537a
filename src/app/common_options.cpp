#include "app/common_options.h"

#include <CLI/CLI.hpp>

namespace troffer {

void add_light_choice(CLI::App& command, std::vector<std::string>& lights) {
  command.add_option("--light", lights, "Only these sources emit (names as info lists them)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Threads [all cores]")->check(CLI::Range(1, 4096));
}

void add_seed(CLI::App& command, uint64_t& seed) {
  command.add_option("--seed", seed, "Seed of the random numbers")->capture_default_str();
}

}  // namespace troffer
