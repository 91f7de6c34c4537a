// Switches that leave single rules of the method out, to measure what each rule gains
// (bench/ablation). They exist only in builds with TROFFER_ABLATION, where the environment variable
// TROFFER_WITHOUT names the rules to leave out, separated by commas. In all other builds the
// compiler removes them.
#pragma once

#include <algorithm>
#include <cstddef>
#ifdef TROFFER_ABLATION
#include <cstdlib>
#include <string_view>
#endif

namespace troffer {

// Name of a rule, as a template argument.
template <size_t size>
struct RuleName {
  // NOLINTNEXTLINE(google-explicit-constructor): a literal is the argument
  consteval RuleName(const char (&name)[size]) { std::copy_n(name, size, text); }
  char text[size];
};

#ifdef TROFFER_ABLATION

// Returns true if the environment variable names this rule.
template <RuleName name>
bool is_left_out() {
  static const bool is_named = [] {
    const char* value = std::getenv("TROFFER_WITHOUT");
    std::string_view rest = value != nullptr ? value : "";
    while (!rest.empty()) {
      const size_t comma = std::min(rest.find(','), rest.size());
      if (rest.substr(0, comma) == name.text) return true;
      rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return false;
  }();
  return is_named;
}

#else

template <RuleName name>
constexpr bool is_left_out() {
  return false;
}

#endif

}  // namespace troffer
