# Files that `cmake --install` and `cpack` install: the program with its manual and completion, the
# library with its headers (find_package(troffer), target troffer::troffer), and the Python module.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS troffer)
# The library consists of the public headers and static libraries. Other projects link
# troffer::troffer. Static libraries need the rooms below it, so these are exported too, with names
# that mark them as private.
set(_linked api)
set(_next api)
while(_next)
  list(POP_FRONT _next _room)
  foreach(_use IN LISTS TROFFER_USES_${_room})
    if(NOT _use IN_LIST _linked)
      list(APPEND _linked ${_use})
      list(APPEND _next ${_use})
    endif()
  endforeach()
endwhile()
foreach(_room IN LISTS _linked)
  set_target_properties(troffer_${_room} PROPERTIES EXPORT_NAME private_${_room})
  install(TARGETS troffer_${_room} EXPORT troffer-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/troffer)
endforeach()
set_target_properties(troffer_api PROPERTIES EXPORT_NAME troffer)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/troffer DESTINATION include
  FILES_MATCHING PATTERN "*.h")
set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/troffer)
install(EXPORT troffer-targets NAMESPACE troffer:: DESTINATION ${_package})
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/troffer-config.cmake.in
  ${CMAKE_BINARY_DIR}/troffer-config.cmake INSTALL_DESTINATION ${_package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/troffer-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/troffer-config.cmake
  ${CMAKE_BINARY_DIR}/troffer-config-version.cmake DESTINATION ${_package})

# Makes manual pages and completion from the help texts of the program.
if(Python_Interpreter_FOUND)
  set(_manual ${CMAKE_BINARY_DIR}/manual)
  add_custom_command(OUTPUT ${_manual}/troffer.1
    COMMAND ${Python_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tools/manual.py $<TARGET_FILE:troffer>
      ${PROJECT_VERSION} ${_manual}
    DEPENDS troffer ${CMAKE_SOURCE_DIR}/tools/manual.py ${CMAKE_SOURCE_DIR}/tools/completion.py
      ${CMAKE_SOURCE_DIR}/tools/program_help.py VERBATIM)
  add_custom_target(manual ALL DEPENDS ${_manual}/troffer.1)
  install(DIRECTORY ${_manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
    FILES_MATCHING PATTERN "*.1")
  install(FILES ${_manual}/troffer.bash RENAME troffer
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${_manual}/_troffer DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${_manual}/troffer.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()
if(TROFFER_MPI)
  install(TARGETS troffer-mpi COMPONENT mpi)  # separate package: other users do not need MPI
endif()
if(TROFFER_PYTHON)
  install(TARGETS troffer_module DESTINATION lib/python3/dist-packages)
  install(FILES ${CMAKE_SOURCE_DIR}/src/python/troffer.pyi DESTINATION lib/python3/dist-packages)
endif()
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/README.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME troffer)
set(CPACK_PACKAGE_CONTACT "the troffer project")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Physically based light in rooms: pictures and lux figures")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME troffer)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS "python3, python3-numpy, troffer-mpi")
set(CPACK_DEBIAN_MPI_PACKAGE_NAME troffer-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "troffer (= ${PROJECT_VERSION}), openmpi-bin")
set(CPACK_COMPONENT_MPI_DESCRIPTION "troffer's pictures by many processes (MPI)")
set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION_SUMMARY}")
include(CPack)
