#include "app/commands.h"
#include "app/launcher.h"

int main(int argc, char** argv) {
  if (const int status = troffer::hand_over_to_mpi(argc, argv); status != 0) return status;
  return troffer::run(argc, argv);
}
