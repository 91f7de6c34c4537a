// Words of Radiance's scene files.
//
// References: [1] G. W. Larson, R. Shakespeare, "Rendering with Radiance", 1998, appendix A (scene
//   description); [2] "The RADIANCE 5.1 Synthetic Imaging System" (reference manual, refman.pdf).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "import/source_place.h"

namespace troffer {

// What a primitive says after its modifier, type and identifier.
struct RadianceArguments {
  std::vector<std::string> strings;
  std::vector<double> reals;
};

// Takes a file apart. '#' between words begins a comment up to the end of its line, '!' between
// statements a command up to the end of its line, which a backslash continues.
class RadianceText {
 public:
  // Both must outlive this.
  RadianceText(std::shared_ptr<const std::string> file, std::string_view text)
      : file_(std::move(file)), text_(text) {}

  // The next word, without its quotes (" or '); empty at the end of the file. Comments go by unless
  // they hold a view ("-vp"), which is added to views().
  std::string word();
  // The first word of a statement; "!" where a command begins.
  std::string first_word();
  // The text after '!' up to the end of the line; call where first_word() has returned "!".
  std::string command();
  RadianceArguments arguments();
  // A finite number.
  double number();

  SourcePlace place() const { return {file_, line_of_word_, column_of_word_}; }
  const std::vector<std::string>& views() const { return views_; }

 private:
  std::shared_ptr<const std::string> file_;
  std::string_view text_;
  size_t at_ = 0, line_begin_ = 0;
  int line_ = 1, line_of_word_ = 1, column_of_word_ = 1;
  std::vector<std::string> views_;

  void skip_blanks();
  size_t count();
  std::string argument(const char* what);
};

// Words of a command or of a view, separated by blanks; quotes hold words together.
std::vector<std::string> words_of(std::string_view line);

// A finite number, or an error at that place.
double radiance_number(const std::string& word, const SourcePlace& place);

}  // namespace troffer
