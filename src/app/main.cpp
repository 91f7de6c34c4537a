#include "app/commands.h"

int main(int argc, char** argv) {
  return troffer::run(argc, argv);
}
