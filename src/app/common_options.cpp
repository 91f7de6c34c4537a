#include "app/common_options.h"

#include <CLI/CLI.hpp>

#include "app/option_values.h"
#include "render/render.h"

namespace troffer {

void add_method(CLI::App& command, std::string& method) {
  std::string names = Method::names();  // "a, b or c"
  names.replace(names.find(" or "), 4, ", ");
  std::vector<std::string> words;
  for (const std::string& word : split_at(names, ','))
    words.push_back(word.substr(word.find_first_not_of(' ')));
  command.add_option("--method", method, "How light is computed")
      ->check(one_of(words))
      ->capture_default_str();
}

void add_indirect(CLI::App& command, std::string& indirect) {
  command
      .add_option("--indirect", indirect,
                  "Reflected light. auto: chosen by the method; cells: gathered from cache cells "
                  "(certified); radiosity: interpolated (certified, kj92); none: direct light only")
      ->check(one_of({"auto", "cells", "radiosity", "none"}))
      ->capture_default_str();
}

void add_light_choice(CLI::App& command, std::vector<std::string>& lights) {
  command
      .add_option("--light", lights,
                  "Only these light sources emit; troffer info lists their names")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_threads(CLI::App& command, int& threads) {
  command
      .add_option("--threads", threads,
                  "Threads [all cores]; the result is the same for any number")
      ->check(whole_number_between(1, 4096));
}

void add_seed(CLI::App& command, uint64_t& seed) {
  command
      .add_option("--seed", seed, "Seed of the random numbers; another seed gives different noise")
      ->capture_default_str();
}

}  // namespace troffer
