#!/usr/bin/env bash
# Every header of src/ compiles alone.   headers_alone.sh COMPILER SOURCE_DIR [FLAGS…]
set -u
compiler=$1; source_dir=$2; shift 2
export compiler source_dir
export flags="$*"
check_one() {
  header=${1#"$source_dir/src/"}
  # shellcheck disable=SC2086
  echo "#include \"$header\"" |
    $compiler -std=c++20 -fsyntax-only -w $flags -I"$source_dir/src" -x c++ - || {
    echo "does not compile alone: $header"
    return 1
  }
}
export -f check_one
find "$source_dir/src" -name '*.h' -print0 | xargs -0 -n 1 -P "$(nproc)" bash -c 'check_one "$0"'
