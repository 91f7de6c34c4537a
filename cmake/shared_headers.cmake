# What nearly every source includes is compiled once for all rooms: half of a source's time went to
# that. Sources still include what they use: builds with a compiler cache, which do not keep what
# was compiled so, do without.
function(troffer_shared_headers first)
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  target_precompile_headers(troffer_${first} PRIVATE <algorithm> <array> <atomic> <cmath> <cstdint>
    <cstring> <functional> <map> <memory> <optional> <span> <string> <string_view>
    <unordered_map> <utility> <vector> <fmt/format.h> <base/rgb.h> <base/vec.h>)
  foreach(_room IN LISTS ARGN)
    get_target_property(_type troffer_${_room} TYPE)
    if(_type STREQUAL "INTERFACE_LIBRARY")
      continue()
    endif()
    if(NOT _room STREQUAL first)
      target_precompile_headers(troffer_${_room} REUSE_FROM troffer_${first})
    endif()
    # GCC 12 forgets that these are a system's headers, and warns of sound strings.
    target_compile_options(troffer_${_room} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
  endforeach()
endfunction()
