// A program that has nothing but what is installed: prints the illuminance at a point.
#include <cstdio>

#include "import/import.h"
#include "render/measure.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const troffer::PreparedScene scene(troffer::import_scene(argv[1]));
  const troffer::StopFlag stop{false};
  const troffer::MeasureResult r = troffer::measure(
      scene, {{{1.5, 2.1, 0.77}, {0, 0, 1}}}, {}, [](double) {}, stop);
  std::printf("%.4f\n", r.values.at(0).illuminance_lx);
}
