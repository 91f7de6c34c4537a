#include "import/luminaire.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "import/file.h"
#include "import/photometric_text.h"

namespace troffer {

namespace {

constexpr uint64_t max_file_bytes = uint64_t(64) << 20;
constexpr size_t max_values = size_t(4) << 20;
constexpr double least_candela = 1e-12;  // of the largest intensity of a file
constexpr double most_candela = 1e12, most_lumens = 1e12, most_metres = 1e4;
constexpr double metres_per_foot = 0.3048;

// Planes as a file has them.
struct Planes {
  std::vector<double> heights_deg, turns_deg;
  std::vector<double> candela;  // per turn, per height
};

void check_ascending(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name) {
  for (size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i] > angles[i - 1])) text.fail(fmt::format("{} do not ascend", name));
}

// Whole turns, from 0 to 360, of planes that begin anywhere and end with their symmetry.
class Unfolder {
 public:
  Unfolder(const Planes& planes, WarningLog& warnings, const std::string& name)
      : planes_(planes), warnings_(warnings), name_(name) {}

  LightWeb web() {
    const std::vector<double>& turns = planes_.turns_deg;
    const double first = turns.front(), last = turns.back();
    if (turns.size() == 1) {
      add(0, 0);
      add(360, 0);
    } else if (first == 0 && last == 90) {
      add_all(0, +1);
      add_all(180, -1);
      add_all(180, +1);
      add_all(360, -1);
    } else if (first == 0 && last == 180) {
      add_all(0, +1);
      add_all(360, -1);
    } else if (first == 90 && last == 270) {
      add_all(0, +1);
      add_all(180, -1);  // 90 … -90
    } else {
      add_all(0, +1);
      if (last - first < 360) {
        if (first + 360 - last > 1.5 * (last - turns[turns.size() - 2]))
          warnings_.add(name_ + ": planes do not go round; the first follows upon the last");
        add(first + 360, 0);
      }
    }
    return sorted();
  }

 private:
  struct Plane {
    double turn;
    size_t row;
  };
  void add(double turn, size_t row) { made_.push_back({turn, row}); }
  void add_all(double offset, double sign) {
    for (size_t i = 0; i < planes_.turns_deg.size(); ++i)
      add(offset + sign * planes_.turns_deg[i], i);
  }

  LightWeb sorted() {
    // Within [0, 360), each once; then the first again at 360.
    for (Plane& p : made_) p.turn -= 360 * std::floor(p.turn / 360);
    std::stable_sort(made_.begin(), made_.end(),
                     [](const Plane& a, const Plane& b) { return a.turn < b.turn; });
    made_.erase(std::unique(made_.begin(), made_.end(),
                            [](const Plane& a, const Plane& b) {
                              return std::abs(a.turn - b.turn) < 1e-6;
                            }),
                made_.end());
    const size_t n = planes_.heights_deg.size();
    std::vector<double> turns;
    std::vector<const double*> rows;
    for (const Plane& p : made_) {
      turns.push_back(p.turn);
      rows.push_back(planes_.candela.data() + p.row * n);
    }
    LightWeb web;
    web.name = name_;
    for (const double h : planes_.heights_deg) web.heights_rad.push_back(float(rad_from_deg(h)));
    // The seam is at 0 whatever turn the first plane has: planes there by what lies beside it.
    const double gap = turns.front() + 360 - turns.back();
    const double share = turns.front() > 0 ? (360 - turns.back()) / gap : 1;
    const auto add_row = [&](double turn, const double* a, const double* b, double t) {
      web.turns_rad.push_back(float(rad_from_deg(turn)));
      for (size_t j = 0; j < n; ++j) web.intensities.push_back(float(a[j] + (b[j] - a[j]) * t));
    };
    if (turns.front() > 0) add_row(0, rows.back(), rows.front(), share);
    for (size_t i = 0; i < turns.size(); ++i) add_row(turns[i], rows[i], rows[i], 0);
    add_row(360, rows.back(), rows.front(), share);
    web.turns_rad.back() = 2 * pi_f;
    return web;
  }

  const Planes& planes_;
  WarningLog& warnings_;
  std::string name_;
  std::vector<Plane> made_;
};

void finish(Luminaire& l, Planes& planes, PhotometricText& text, WarningLog& warnings,
            const std::string& path) {
  size_t negative = 0;
  bool is_dark = true;
  for (double& c : planes.candela) {
    negative += c < 0 ? 1 : 0;
    c = std::max(c, 0.0);
    is_dark = is_dark && c < least_candela;
  }
  if (is_dark) text.fail("no intensity is above 0");
  if (negative > 0)
    warnings.add(fmt::format("{}: {} intensities below 0 count as 0", path, negative));
  if (text.has_met_decimal_commas()) warnings.add(path + ": decimal commas are read as points");
  l.web = Unfolder(planes, warnings, path).web();
}

// ---- LM-63 ----

std::string_view after_equals(std::string_view line) {
  line.remove_prefix(line.find('=') + 1);
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  return line;
}

// Up to the line TILT=; what stands before it is text for people.
void read_labels(PhotometricText& text, Luminaire& l, WarningLog& warnings,
                 const std::string& path) {
  std::string_view line;
  constexpr size_t most_labels = 10'000;
  for (size_t n = 0; text.next_line(line); ++n) {
    if (n > most_labels) break;
    if (line.starts_with("TILT")) {
      const std::string_view tilt = after_equals(line);
      if (tilt == "INCLUDE") {
        text.number("lamp to luminaire geometry", -1e9, 1e9);
        const int pairs = text.integer("number of tilt angles", 0, 10'000);
        for (int i = 0; i < 2 * pairs; ++i) text.number("tilt", -1e9, 1e9);
        warnings.add(path + ": factors for a tilted lamp are left aside");
      } else if (tilt != "NONE") {
        warnings.add(path + ": the file of tilt factors is left aside");
      }
      return;
    }
    for (const char* label : {"[LUMINAIRE]", "[LUMCAT]"})
      if (line.starts_with(label) && l.description.empty())
        l.description = std::string(trimmed(line.substr(std::string_view(label).size(), 200)));
  }
  text.fail("no line begins with TILT=");
}

Luminaire read_ies(const std::string& path, std::string_view bytes, WarningLog& warnings) {
  PhotometricText text(path, bytes);
  Luminaire l;
  read_labels(text, l, warnings, path);
  const int lamps = text.integer("number of lamps", 0, 1'000'000);
  const double lumens = text.number("lumens per lamp", -1, most_lumens);
  double factor = text.number("multiplier", 0, 1e9);
  const auto heights = size_t(text.integer("number of vertical angles", 2, 100'000));
  const auto turns = size_t(text.integer("number of horizontal angles", 1, 100'000));
  if (heights * turns > max_values) text.fail("too many intensities");
  const int type = text.integer("photometric type", 1, 3);
  if (type != 1) text.fail(fmt::format("photometry of type {} is not read", type == 2 ? "B" : "A"));
  const double unit = text.integer("type of units", 1, 2) == 1 ? metres_per_foot : 1;
  l.width = text.number("width", -most_metres, most_metres) * unit;
  l.length = text.number("length", -most_metres, most_metres) * unit;
  l.height = text.number("height", -most_metres, most_metres) * unit;
  l.is_round = l.width < 0 || l.length < 0;  // 1995 and later: negative diameters
  l.width = std::abs(l.width);
  l.length = std::abs(l.length);
  factor *= text.number("ballast factor", 0, 1e6);
  const double future = text.number("ballast-lamp factor", 0, 1e6);
  if (future > 0) factor *= future;
  l.watts = text.number("watts", 0, 1e9);
  if (lumens > 0) l.lamp_lumens = lumens * lamps;
  Planes planes;
  for (size_t i = 0; i < heights; ++i)
    planes.heights_deg.push_back(text.number("vertical angle", 0, 180));
  check_ascending(planes.heights_deg, text, "vertical angles");
  for (size_t i = 0; i < turns; ++i)
    planes.turns_deg.push_back(text.number("horizontal angle", 0, 360));
  check_ascending(planes.turns_deg, text, "horizontal angles");
  for (size_t i = 0; i < heights * turns; ++i)
    planes.candela.push_back(factor * text.number("intensity", -most_candela, most_candela));
  finish(l, planes, text, warnings, path);
  return l;
}

// ---- EULUMDAT ----

// Planes that are there [2]: all, one, those of half a turn from C0 or from C90, of a quarter.
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

// Shifts planes from -90 … 90 to 90 … 270 by their mirror image, which the unfolder knows.
void mirror(Planes& planes) {
  const size_t n = planes.heights_deg.size(), rows = planes.turns_deg.size();
  Planes turned = planes;
  for (size_t i = 0; i < rows; ++i) {
    turned.turns_deg[i] = 180 - planes.turns_deg[rows - 1 - i];
    std::copy_n(planes.candela.begin() + ptrdiff_t((rows - 1 - i) * n), n,
                turned.candela.begin() + ptrdiff_t(i * n));
  }
  planes = turned;
}

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
  if (heights * turn_count > max_values) text.fail("too many intensities");
  skip(2);
  l.description = std::string(line.substr(0, 200));
  skip(3);  // number, file, date
  skip(3);  // housing
  constexpr double mm = 1e-3;
  l.length = mm * text.number_of_line("length of the luminous area", -1e7, 1e7);
  l.width = mm * text.number_of_line("width of the luminous area", -1e7, 1e7);
  l.is_round = !(l.width > 0);
  if (l.is_round) l.width = l.length;
  l.height = mm * text.number_of_line("height of the luminous area", -1e7, 1e7);
  skip(3);
  text.number_of_line("downward flux fraction", -1e6, 1e6);
  text.number_of_line("light output ratio", -1e6, 1e6);
  const double conversion = text.number_of_line("conversion factor", 0, 1e6);
  text.number_of_line("tilt", -1e6, 1e6);
  const int sets = text.integer_of_line("number of sets of lamps", 0, 1000);
  for (int i = 0; i < sets; ++i) {
    skip(2);
    const double lumens = text.number_of_line("lumens", -1e12, most_lumens);
    skip(2);
    const double watts = text.number_of_line("watts", -1e9, 1e9);
    if (i == 0) {  // others are alternatives
      l.lamp_lumens = std::max(0.0, lumens);
      l.watts = std::max(0.0, watts);
    }
  }
  for (int i = 0; i < 10; ++i) text.number_of_line("utilisation", -1e6, 1e6);
  Planes planes;
  std::vector<double> turns;
  for (size_t i = 0; i < turn_count; ++i) turns.push_back(text.number_of_line("C angle", 0, 360));
  for (size_t i = 0; i < heights; ++i)
    planes.heights_deg.push_back(text.number_of_line("gamma angle", 0, 180));
  check_ascending(planes.heights_deg, text, "gamma angles");
  planes.turns_deg = planes_present(symmetry, turns, text);
  if (!(l.lamp_lumens > 0)) text.fail("no lumens are stated, by which intensities per 1000 count");
  const double factor = l.lamp_lumens / 1000 * (conversion > 0 ? conversion : 1);
  for (size_t i = 0; i < heights * planes.turns_deg.size(); ++i)
    planes.candela.push_back(factor *
                             text.number_of_line("intensity", -most_candela, most_candela));
  if (symmetry == 3) mirror(planes);
  finish(l, planes, text, warnings, path);
  return l;
}

}  // namespace

Luminaire read_luminaire(const std::string& path, WarningLog& warnings) {
  const std::string text = read_text_file(path, max_file_bytes);
  Luminaire l = lower_case_ending(path) == "ldt" ? read_ldt(path, text, warnings)
                                                 : read_ies(path, text, warnings);
  l.web.name = path;
  return l;
}

}  // namespace troffer
