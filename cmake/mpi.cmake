# The program that takes part in a picture by many processes (troffer-mpi), where MPI is installed:
# Debian's libopenmpi-dev.

find_package(MPI QUIET COMPONENTS C)
option(TROFFER_MPI "Build troffer-mpi (MPI)" ${MPI_C_FOUND})
if(TROFFER_MPI)
  find_package(MPI REQUIRED COMPONENTS C)
endif()

function(troffer_mpi_program)
  add_executable(troffer-mpi src/mpi/main.cpp)
  target_link_libraries(troffer-mpi PRIVATE troffer_mpi troffer_app)
  set_target_properties(troffer-mpi PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  # `troffer render` goes on as this one under mpirun.
  add_dependencies(troffer troffer-mpi)
endfunction()
