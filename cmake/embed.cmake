# cmake -D OUTPUT=FILE.cpp -D FILES=a;b -P embed.cmake: writes text files as strings of a C++ source
# (src/view/page_files.h).
cmake_policy(VERSION 3.25)
set(_rows "")
foreach(_file IN LISTS FILES)
  get_filename_component(_name ${_file} NAME)
  file(READ ${_file} _hex HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" _bytes "${_hex}")
  # Compilers handle several short lines better than one long string.
  string(REGEX REPLACE "((\\\\x..)(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?)"
    "\"\\1\"\n" _lines "${_bytes}")
  string(LENGTH "${_hex}" _digits)
  math(EXPR _size "${_digits} / 2")
  string(APPEND _rows "    {\"${_name}\", {\n${_lines}, ${_size}}},\n")
endforeach()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "#include \"view/page_files.h\"

namespace troffer {

namespace {

constexpr PageFile files[] = {
@_rows@};

}  // namespace

std::span<const PageFile> page_files() {
  return files;
}

}  // namespace troffer
")
