// A program that has nothing but what is installed: prints the illuminance at a point.
#include <troffer/troffer.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    auto scene = troffer::api::Scene::load(argv[1]);
    const auto found = troffer::api::measure(scene, {{{1.5, 2.1, 0.77}, {0, 0, 1}}});
    std::printf("%.4f\n", found.values.at(0).illuminance);
  } catch (const troffer::InputError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
