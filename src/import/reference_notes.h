// Notes on files that references found under another name than the one they ask for.
//
// confined_path (file.h) looks for a file under its very name first. Where there is none it tries
// names as other machines write them: '\' between components, letters of another case, and of a
// Windows path with a drive or a share its last components.
#pragma once

#include <string>
#include <vector>

namespace troffer {

// Collects what confined_path on this thread notes while it lives: files that were found under
// another name than the one asked for. The innermost one collects.
class ReferenceNotes {
 public:
  ReferenceNotes();
  ~ReferenceNotes();
  ReferenceNotes(const ReferenceNotes&) = delete;
  ReferenceNotes& operator=(const ReferenceNotes&) = delete;

  const std::vector<std::string>& notes() const { return notes_; }  // each once, in order
  static void note(const std::string& text);

 private:
  std::vector<std::string> notes_;
  ReferenceNotes* outer_;
  static thread_local ReferenceNotes* innermost_;
};

}  // namespace troffer
