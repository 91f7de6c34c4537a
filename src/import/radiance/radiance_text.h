// Tokenizer of Radiance's scene files, and parsers of words and numbers. Used by all readers of
// this folder.
//
// References: [1] G. W. Larson, R. Shakespeare, "Rendering with Radiance", 1998, appendix A (scene
//   description); [2] "The RADIANCE 5.1 Synthetic Imaging System" (reference manual, refman.pdf).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "import/source_place.h"

namespace troffer {

// Arguments of a primitive, after its modifier, type and identifier.
struct RadianceArguments {
  std::vector<std::string> strings;
  std::vector<double> reals;
};

// Splits a file into words. '#' between words begins a comment up to the end of the line. '!'
// between statements begins a command up to the end of the line; a backslash continues it.
class RadianceText {
 public:
  // Both must outlive this object.
  RadianceText(std::shared_ptr<const std::string> file, std::string_view text)
      : file_(std::move(file)), text_(text) {}

  // Returns the next word, without its quotes (" or '); empty at the end of the file. Comments are
  // skipped; those with a view ("-vp") are added to views().
  std::string word();
  // Returns the first word of a statement, or "!" at the start of a command.
  std::string first_word();
  // Returns the text after '!' up to the end of the line. Call it after first_word() has returned
  // "!".
  std::string command();
  RadianceArguments arguments();
  // Reads a finite number.
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

// Splits a command or view into words, separated by blanks. Quotes keep words together.
std::vector<std::string> words_of(std::string_view line);

// Parses a finite number. Throws InputError at that place.
double radiance_number(const std::string& word, const SourcePlace& place);

}  // namespace troffer
