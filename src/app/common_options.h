// Options that several commands share, with the same descriptions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace troffer {

void add_method(CLI::App& command, std::string& method);
void add_indirect(CLI::App& command, std::string& indirect);
void add_light_choice(CLI::App& command, std::vector<std::string>& lights);
void add_threads(CLI::App& command, int& threads);
void add_seed(CLI::App& command, uint64_t& seed);

}  // namespace troffer
