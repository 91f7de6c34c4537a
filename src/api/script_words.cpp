#include "api/script_words.h"

#include <cctype>

namespace troffer {

std::string in_script_words(const std::string& message) {
  std::string out;
  bool is_option = false;
  const auto is_letter = [&](size_t i) {
    return i < message.size() && std::isalpha(static_cast<unsigned char>(message[i])) != 0;
  };
  for (size_t i = 0; i < message.size(); ++i) {
    if (message.compare(i, 2, "--") == 0 && is_letter(i + 2)) {
      is_option = true;
      ++i;
      continue;
    }
    is_option = is_option && (is_letter(i) || (message[i] == '-' && is_letter(i + 1)));
    out += is_option && message[i] == '-' ? '_' : message[i];
  }
  return out;
}

}  // namespace troffer
