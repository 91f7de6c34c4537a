# Builds the Python module (import troffer) if pybind11 is installed. It is for the interpreter
# Python_EXECUTABLE, by default Debian's own, which Debian's numpy belongs to.

if(EXISTS /usr/bin/python3 AND NOT DEFINED Python_EXECUTABLE)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Interpreter the module is for")
endif()
find_package(Python COMPONENTS Interpreter OPTIONAL_COMPONENTS Development.Module)
find_path(TROFFER_PYBIND11_HEADERS pybind11/pybind11.h)
set(_can_build OFF)
if(Python_Development.Module_FOUND AND TROFFER_PYBIND11_HEADERS)
  set(_can_build ON)
endif()
option(TROFFER_PYTHON "Build the Python module (pybind11)" ${_can_build})
if(TROFFER_PYTHON)
  set(PYBIND11_FINDPYTHON ON)
  find_package(pybind11 CONFIG REQUIRED)
  # Code in the module must be position independent. No other library replaces its functions.
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
endif()

function(troffer_python_module)
  target_link_libraries(troffer_python PUBLIC pybind11::pybind11)
  target_compile_options(troffer_python PRIVATE -fvisibility=hidden $<$<CONFIG:Release>:-O1>)
  pybind11_add_module(troffer_module MODULE NO_EXTRAS src/python/module.cpp)
  target_link_libraries(troffer_module PRIVATE troffer_python troffer_options)
  target_compile_definitions(troffer_module PRIVATE TROFFER_VERSION="${PROJECT_VERSION}")
  set_target_properties(troffer_module PROPERTIES OUTPUT_NAME troffer
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python)
endfunction()
