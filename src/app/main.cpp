#include "app/commands.h"
#include "app/large_pages.h"
#include "app/launcher.h"

int main(int argc, char** argv) {
  if (const int status = troffer::hand_over_to_mpi(argc, argv); status != 0) return status;
  troffer::use_large_pages();
  return troffer::run(argc, argv);
}
