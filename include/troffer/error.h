/// @file
/// The exceptions that troffer throws.
///
/// Functions of the library throw only these types, and std::bad_alloc if memory runs out. The
/// types live in namespace troffer; namespace troffer::api has aliases such as
/// troffer::api::InputError.
#pragma once

#include <stdexcept>
#include <string>

namespace troffer {

/// A file cannot be used: it is missing or damaged, or it needs a feature that is not supported.
/// what() reads "FILE:LINE:COLUMN: reason".
class InputError : public std::runtime_error {
 public:
  /// @param file path of the file
  /// @param line line, from 1; 0: the whole file, printed as 1:1; -1: no position, not printed
  /// @param column column, from 1; 0: unknown
  /// @param what the reason, without the position
  InputError(std::string file, int line, int column, std::string what);
  /// Path of the file.
  const std::string& file() const { return file_; }
  /// The reason, without the position.
  const std::string& reason() const { return reason_; }
  /// Line, from 1; 0: the whole file; -1: no position.
  int line() const { return line_; }
  /// Column, from 1; 0: unknown.
  int column() const { return column_; }

 private:
  std::string file_, reason_;
  int line_, column_;
};

/// The environment failed: a file cannot be written, the disk is full or memory ran out.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument is invalid: an unknown name, a number outside its range or an array of the wrong
/// size.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The public interface of the library.
namespace api {
using troffer::EnvironmentError;
using troffer::InputError;
using troffer::UsageError;
}  // namespace api

}  // namespace troffer
