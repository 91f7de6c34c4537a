# Builds troffer-mpi, the program for pictures by many processes, if MPI is installed (Debian's
# libopenmpi-dev).

find_package(MPI QUIET COMPONENTS C)
option(TROFFER_MPI "Build troffer-mpi (MPI)" ${MPI_C_FOUND})
if(TROFFER_MPI)
  find_package(MPI REQUIRED COMPONENTS C)
endif()

function(troffer_mpi_program)
  add_executable(troffer-mpi src/mpi/main.cpp)
  target_link_libraries(troffer-mpi PRIVATE troffer_mpi troffer_app)
  set_target_properties(troffer-mpi PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  # Under mpirun, `troffer render` replaces itself by this program.
  add_dependencies(troffer troffer-mpi)
endfunction()
