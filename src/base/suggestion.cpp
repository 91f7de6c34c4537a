#include "base/suggestion.h"

#include <algorithm>
#include <cctype>

namespace troffer {

namespace {

constexpr size_t longest = 200;  // characters that are compared; names may come from files

std::string lower(std::string_view text) {
  std::string s(text.substr(0, longest));
  std::transform(s.begin(), s.end(), s.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return s;
}

}  // namespace

size_t edit_distance(std::string_view a_text, std::string_view b_text) {
  const std::string a = lower(a_text), b = lower(b_text);
  std::vector<size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  constexpr size_t shortest_beginning = 3, most_names = 100'000;
  std::string best;
  size_t least = std::min(std::max<size_t>(1, word.size() / 3) + 1, word.size());
  const std::string typed = lower(word);
  for (size_t i = 0; i < std::min(names.size(), most_names); ++i) {
    const std::string& name = names[i];
    if (name == word) continue;  // it exists and was refused for another reason
    const size_t difference =
        name.size() > word.size() ? name.size() - word.size() : word.size() - name.size();
    const bool is_beginning = word.size() >= shortest_beginning && lower(name).starts_with(typed);
    if (difference >= least && !is_beginning) continue;
    // A prefix counts as a difference of one letter.
    const size_t distance = is_beginning && difference > 0 ? 1 : edit_distance(word, name);
    if (distance >= least) continue;
    least = distance;
    best = name;
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace troffer
