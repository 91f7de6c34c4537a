#include <algorithm>
#include <array>

#include "import/luminaire/luminaire_angles.h"
#include "import/luminaire/luminaire_formats.h"

namespace troffer {

namespace {

// Returns the angles of the planes in the file by its symmetry number [2]: 0 all planes, 1 a single
// one, 2 C0 to C180, 3 C270 to C90, 4 C0 to C90.
std::vector<double> planes_present(int symmetry, const std::vector<double>& turns,
                                   PhotometricText& text) {
  const size_t n = turns.size();
  size_t first = 0, count = n;
  if (symmetry == 1) count = 1;
  if (symmetry == 2) count = n / 2 + 1;
  if (symmetry == 3) count = n / 2 + 1;
  if (symmetry == 4) count = n / 4 + 1;
  if (symmetry == 3) first = n - n / 4;
  std::vector<double> present;
  for (size_t i = 0; i < count; ++i) {
    const size_t at = (first + i) % n;
    present.push_back(turns[at] - (symmetry == 3 && turns[at] > 180 ? 360 : 0));
  }
  if (symmetry == 1) present = {0};
  check_ascending(present, text, "C-planes");
  return present;
}

LuminousOpening read_opening(PhotometricText& text) {
  constexpr double mm = 1e-3, most = 1e7;
  const double length = mm * text.number_of_line("length of the luminous area", -most, most);
  const double width = mm * text.number_of_line("width of the luminous area", -most, most);
  std::array<double, 4> sides{};
  for (double& side : sides)
    side = mm * text.number_of_line("height of the luminous area", -most, most);
  return eulumdat_opening(length, width, sides);
}

// Reads the angles; leaves intensities empty.
Planes read_angles(PhotometricText& text, int symmetry, size_t turn_count, size_t heights,
                   const std::string& path, WarningLog& warnings) {
  Planes planes;
  std::vector<double> turns;
  for (size_t i = 0; i < turn_count; ++i)
    turns.push_back(text.number_of_line("C angle", -angle_slack_deg, 360 + angle_slack_deg));
  for (size_t i = 0; i < heights; ++i)
    planes.vertical_angles_deg.push_back(
        text.number_of_line("gamma angle", -angle_slack_deg, 180 + angle_slack_deg));
  check_ascending(planes.vertical_angles_deg, text, "gamma angles");
  snap_ends(planes.vertical_angles_deg, "gamma angles", path, warnings);
  if (planes.vertical_angles_deg.front() < 0 || planes.vertical_angles_deg.back() > 180)
    text.fail("gamma angles lie between 0 and 180");
  planes.horizontal_angles_deg = planes_present(symmetry, turns, text);
  snap_ends(planes.horizontal_angles_deg, "C-planes", path, warnings);
  return planes;
}

}  // namespace

Luminaire read_ldt(const std::string& path, std::string_view bytes, WarningLog& warnings) {
  PhotometricText text(path, bytes);
  Luminaire l;
  std::string_view line;
  const auto skip = [&](int lines) {
    for (int i = 0; i < lines; ++i)
      if (!text.next_line(line)) text.fail("the file ends too soon");
  };
  skip(1);
  text.number_of_line("type of luminaire", 0, 9);
  const int symmetry = text.integer_of_line("symmetry", 0, 4);
  const auto turn_count = size_t(text.integer_of_line("number of C-planes", 1, 100'000));
  text.number_of_line("distance of C-planes", 0, 360);
  const auto heights = size_t(text.integer_of_line("number of intensities in a plane", 2, 100'000));
  text.number_of_line("distance of intensities", 0, 180);
  if (heights * turn_count > max_intensities) text.fail("too many intensities");
  skip(2);
  l.description = std::string(line.substr(0, 200));
  skip(3);  // number, file, date
  skip(3);  // housing
  l.opening = read_opening(text);
  text.number_of_line("downward flux fraction", -1e6, 1e6);
  l.output_ratio = std::max(0.0, text.number_of_line("light output ratio", -1e6, 1e6) / 100);
  const double conversion = text.number_of_line("conversion factor", 0, 1e6);
  text.number_of_line("tilt", -1e6, 1e6);
  const int sets = text.integer_of_line("number of sets of lamps", 0, 1000);
  for (int i = 0; i < sets; ++i) {
    skip(1);
    if (i == 0) l.is_absolute = line.starts_with('-');  // number of lamps
    skip(1);
    const double lumens = text.number_of_line("lumens", -1e12, most_lumens);
    skip(2);
    const double watts = text.number_of_line("watts", -1e9, 1e9);
    if (i == 0) {  // further sets are alternatives
      l.lamp_lumens = std::max(0.0, lumens);
      l.watts = std::max(0.0, watts);
    }
  }
  for (int i = 0; i < 10; ++i) text.number_of_line("utilisation", -1e6, 1e6);
  Planes planes = read_angles(text, symmetry, turn_count, heights, path, warnings);
  if (!(l.lamp_lumens > 0)) text.fail("no lumens are stated, but intensities are per 1000 lumens");
  const double factor = l.lamp_lumens / 1000 * (conversion > 0 ? conversion : 1);
  for (size_t i = 0; i < heights * planes.horizontal_angles_deg.size(); ++i)
    planes.candela.push_back(factor *
                             text.number_of_line("intensity", -most_candela, most_candela));
  clean_intensities(planes, text, path, warnings);
  extend_to_poles(planes, path, warnings);
  l.web = unfold_planes(planes, path, warnings);
  return l;
}

}  // namespace troffer
