/// @file
/// Failures that troffer reports by exceptions.
///
/// Every function of the library throws only these types, and std::bad_alloc where memory runs out.
/// The types live in namespace troffer and are also known as troffer::api::InputError and so on.
#pragma once

#include <stdexcept>
#include <string>

namespace troffer {

/// A file that cannot be used as it is: it is missing, damaged, or asks for an unknown feature.
/// what() reads "FILE:LINE:COLUMN: reason".
class InputError : public std::runtime_error {
 public:
  /// @param file path of the file
  /// @param line line from 1; 0: the file as a whole, printed as 1:1
  /// @param column column from 1; 0: unknown
  /// @param what the reason, without the position
  InputError(std::string file, int line, int column, std::string what);
  /// Path of the file.
  const std::string& file() const { return file_; }
  /// The reason, without the position.
  const std::string& reason() const { return reason_; }
  /// Line from 1, or 0 for the file as a whole.
  int line() const { return line_; }
  /// Column from 1, or 0.
  int column() const { return column_; }

 private:
  std::string file_, reason_;
  int line_, column_;
};

/// The environment failed: a file cannot be written, the disk is full, memory ran out.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller asks for something that does not exist or has no meaning: an unknown name, a number
/// outside its range, an array of the wrong size.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What programs use: all public names.
namespace api {
using troffer::EnvironmentError;
using troffer::InputError;
using troffer::UsageError;
}  // namespace api

}  // namespace troffer
