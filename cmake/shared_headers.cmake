# Compiles headers that nearly all sources include once for all rooms, because they take half of a
# source's compile time. Sources still include what they use: builds with a compiler cache, which
# cannot cache such headers, do without. The first room compiles them; HEADERS are more of them.
function(troffer_shared_headers first)
  cmake_parse_arguments(PARSE_ARGV 1 _shared "" "" "ROOMS;HEADERS")
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  target_precompile_headers(troffer_${first} PRIVATE <algorithm> <array> <atomic> <cmath> <cstdint>
    <cstring> <functional> <map> <memory> <optional> <span> <string> <string_view>
    <unordered_map> <utility> <vector> <fmt/format.h> <base/rgb.h> <base/vec.h> ${_shared_HEADERS})
  foreach(_room IN LISTS _shared_ROOMS)
    get_target_property(_type troffer_${_room} TYPE)
    if(_type STREQUAL "INTERFACE_LIBRARY")
      continue()
    endif()
    if(NOT _room STREQUAL first)
      target_precompile_headers(troffer_${_room} REUSE_FROM troffer_${first})
    endif()
    # GCC 12 does not treat these as system headers, and warns of correct strings.
    target_compile_options(troffer_${_room} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
  endforeach()
endfunction()
