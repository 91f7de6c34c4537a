// Notes about files that were found under another name than the one in the scene.
//
// confined_path (file.h) first looks for the exact name. Otherwise it tries names as other machines
// write them: '\' between components, another case, and the last components of a Windows path with
// a drive or share.
#pragma once

#include <string>
#include <vector>

namespace troffer {

// Collects the notes of confined_path on this thread while it exists. If several exist, the
// innermost collects.
class ReferenceNotes {
 public:
  ReferenceNotes();
  ~ReferenceNotes();
  ReferenceNotes(const ReferenceNotes&) = delete;
  ReferenceNotes& operator=(const ReferenceNotes&) = delete;

  const std::vector<std::string>& notes() const { return notes_; }  // without duplicates, in order
  static void note(const std::string& text);

 private:
  std::vector<std::string> notes_;
  ReferenceNotes* outer_;
  static thread_local ReferenceNotes* innermost_;
};

}  // namespace troffer
