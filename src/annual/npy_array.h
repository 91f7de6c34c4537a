// Reads arrays in NumPy's format as HoneybeeFolder writes them: little-endian floats, row by row.
// StoredHours uses it. Files may come from anyone. They are opened for each use, so any number of
// arrays is fine, and a file that shrinks later makes an error.
//
// References: [1] NumPy, "numpy.lib.format".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace troffer {

class NpyArray {
 public:
  // Reads the header [1]. Throws InputError if it announces other numbers or another shape, or if
  // the file is shorter or longer than that.
  NpyArray(std::string path, size_t rows, size_t columns);

  // Returns the columns first … first + count - 1, one after the other. Throws InputError if the
  // file has become shorter.
  std::vector<float> columns(size_t first, size_t count) const;
  std::vector<float> row(size_t number) const;

 private:
  std::string path_;
  size_t rows_, columns_;
  uint64_t first_byte_ = 0;  // of the numbers
};

}  // namespace troffer
