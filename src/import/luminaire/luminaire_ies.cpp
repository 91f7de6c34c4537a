#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/file.h"
#include "import/luminaire/luminaire_angles.h"
#include "import/luminaire/luminaire_formats.h"

namespace troffer {

namespace {

constexpr double metres_per_foot = 0.3048;

std::string upper_case(std::string_view s) {
  std::string out(s);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
  return out;
}

// Extracts the value of a line TILT=…, in either case and with blanks allowed; false for other
// lines.
bool take_tilt(std::string_view line, std::string_view& value) {
  constexpr size_t length = 4;
  if (upper_case(line.substr(0, length)) != "TILT") return false;
  line = trimmed(line.substr(length));
  if (!line.starts_with('=')) return false;
  value = trimmed(line.substr(1));
  return true;
}

// Reads the tilt table: the part after TILT=INCLUDE, or a whole file of tilt factors.
TiltFactors read_tilt(PhotometricText& text) {
  TiltFactors tilt;
  text.number("lamp to luminaire geometry", -1e9, 1e9);
  const int pairs = text.integer("number of tilt angles", 0, 10'000);
  for (int i = 0; i < pairs; ++i) tilt.angles_deg.push_back(text.number("tilt angle", -360, 360));
  for (int i = 0; i < pairs; ++i) tilt.factors.push_back(text.number("tilt factor", 0, 1000));
  check_ascending(tilt.angles_deg, text, "tilt angles");
  return tilt;
}

TiltFactors read_tilt_file(const std::string& path, const std::string& folder,
                           const std::string& name, WarningLog& warnings) {
  const auto leave = [&](const std::string& why) {
    warnings.add(path + ": tilt factors of '" + name + "': " + why + "; ignored");
    return TiltFactors{};
  };
  if (folder.empty()) return leave("no other file may be named here");
  const ConfinedPath tilt = confined_path(folder, name);
  if (!tilt.is_fine()) return leave(tilt.problem);
  try {
    const std::string bytes = read_text_file(tilt.path, max_luminaire_bytes);
    PhotometricText text(tilt.path, bytes);
    return read_tilt(text);
  } catch (const InputError& error) {
    return leave(error.reason());
  }
}

struct Labels {
  int edition = 0;  // year, by the file's first line; 0: unknown
  std::string description;
};

// Returns the year of "IESNA91", "IESNA:LM-63-1995", "IESNA:LM-63-02" or "IES:LM-63-2019"; 0 for
// other lines. The first edition is of 1986, so two digits below 86 mean 20xx.
int edition_of(std::string_view first_line) {
  const std::string line = upper_case(first_line);
  const size_t label = line.find("LM-63-"), old = line.find("IESNA91");
  if (label == line.npos) return old == line.npos ? 0 : 1991;
  const size_t first = label + 6,
               end = std::min(line.find_first_not_of("0123456789", first), line.size());
  const std::string year = line.substr(first, std::min<size_t>(end - first, 5));
  if (year.size() == 4) return std::atoi(year.c_str());
  if (year.size() != 2) return 0;
  const int short_year = std::atoi(year.c_str());
  return short_year + (short_year < 86 ? 2000 : 1900);
}

// Reads keyword lines up to the line TILT=, and returns its value.
std::string_view read_labels(PhotometricText& text, Labels& labels) {
  std::string_view line;
  constexpr size_t most_labels = 10'000;
  bool is_first = true;
  for (size_t n = 0; text.next_line(line) && n <= most_labels; ++n) {
    if (is_first && !line.empty()) {
      labels.edition = edition_of(line);
      is_first = false;
    }
    if (std::string_view tilt; take_tilt(line, tilt)) return tilt;
    for (const char* label : {"[LUMINAIRE]", "[LUMCAT]"})
      if (line.starts_with(label) && labels.description.empty())
        labels.description = std::string(trimmed(line.substr(std::string_view(label).size(), 200)));
  }
  text.fail("no line begins with TILT=");
}

// The ten numbers on the two lines before the angles, as far as they are needed.
struct Header {
  double factor = 1;
  size_t heights = 0, turns = 0;
  int type = 1;
  bool has_zero_factor = false;
};

// True for file generation types of LM-63-2019: 1 and five binary digits after the point.
bool is_generation_type(double v) {
  const double digits = std::round((v - 1) * 1e5);
  if (std::abs((v - 1) * 1e5 - digits) > 1e-3 || digits < 0 || digits > 11'111) return false;
  for (int rest = int(digits); rest > 0; rest /= 10)
    if (rest % 10 > 1) return false;
  return true;
}

// Reads the number between ballast factor and watts, and returns the factor on intensities. It is
// the ballast-lamp photometric factor until 1991, reserved in 1995 and 2002, and the file
// generation type in 2019.
double take_ballast_lamp_factor(PhotometricText& text, int edition, const std::string& path,
                                WarningLog& warnings) {
  const double v = text.number("ballast-lamp factor", 0, 1e6);
  if (edition >= 2019) {
    if (v != 0 && !is_generation_type(v))
      warnings.add(
          fmt::format("{}: {:.6g} is not a file generation type of LM-63-2019; it does not "
                      "multiply intensities",
                      path, v));
    return 1;
  }
  if (v != 1 && v != 0 && edition >= 1995)
    warnings.add(fmt::format(
        "{}: its ballast-lamp factor {:.6g} multiplies intensities (reserved in LM-63-{})", path, v,
        edition));
  return v > 0 ? v : 1;
}

Header read_header(PhotometricText& text, Luminaire& l, int edition, const std::string& path,
                   WarningLog& warnings) {
  Header h;
  const auto take_factor = [&](const char* name, double most) {
    const double factor = text.number(name, 0, most);
    if (factor == 0) h.has_zero_factor = true;
    return factor > 0 ? factor : 1;
  };
  const int lamps = text.integer("number of lamps", 0, 1'000'000);
  const double lumens = text.number("lumens per lamp", -1, most_lumens);
  if (lumens > 0) l.lamp_lumens = lumens * lamps;
  l.is_absolute = lumens < 0;
  h.factor = take_factor("multiplier", 1e9);
  h.heights = size_t(text.integer("number of vertical angles", 2, 100'000));
  h.turns = size_t(text.integer("number of horizontal angles", 1, 100'000));
  if (h.heights * h.turns > max_intensities) text.fail("too many intensities");
  h.type = text.integer("photometric type", 1, 3);
  const double unit = text.integer("type of units", 1, 2) == 1 ? metres_per_foot : 1;
  const double width = text.number("width", -most_metres, most_metres) * unit;
  const double length = text.number("length", -most_metres, most_metres) * unit;
  const double height = text.number("height", -most_metres, most_metres) * unit;
  l.opening = ies_opening(width, length, height, edition < 2002);
  h.factor *= take_factor("ballast factor", 1e6);
  h.factor *= take_ballast_lamp_factor(text, edition, path, warnings);
  l.watts = text.number("watts", 0, 1e9);
  return h;
}

// Warns if numbers follow the intensities: some count in the header is wrong.
void warn_of_extra_numbers(PhotometricText& text, const std::string& path, WarningLog& warnings) {
  std::string_view line;
  while (text.next_line(line))
    if (!line.empty() && line.find_first_not_of("0123456789.,+-eE \t") == std::string_view::npos) {
      warnings.add("'" + path + "' has more intensities than angles; the last ones are left out");
      return;
    }
}

// Reverses descending angles and their intensities, with a warning.
void reverse_descending_angles(Planes& planes, const std::string& path, WarningLog& warnings) {
  const size_t n = planes.vertical_angles_deg.size(), rows = planes.horizontal_angles_deg.size();
  const auto descends = [](const std::vector<double>& v) {
    return v.size() > 1 && std::is_sorted(v.rbegin(), v.rend()) && v.front() > v.back();
  };
  const bool do_heights = descends(planes.vertical_angles_deg),
             do_turns = descends(planes.horizontal_angles_deg);
  if (!do_heights && !do_turns) return;
  if (do_heights)
    std::reverse(planes.vertical_angles_deg.begin(), planes.vertical_angles_deg.end());
  if (do_turns)
    std::reverse(planes.horizontal_angles_deg.begin(), planes.horizontal_angles_deg.end());
  if (planes.candela.size() == n * rows) {
    std::vector<double> turned(planes.candela.size());
    for (size_t i = 0; i < rows; ++i)
      for (size_t j = 0; j < n; ++j)
        turned[i * n + j] =
            planes.candela[(do_turns ? rows - 1 - i : i) * n + (do_heights ? n - 1 - j : j)];
    planes.candela = std::move(turned);
  }
  warnings.add(path + ": its angles descend");
}

// Reads angles and snaps their ends. Fails unless all then lie within [least, most].
std::vector<double> read_angles(PhotometricText& text, size_t count, const char* what, double least,
                                double most, const std::string& path, WarningLog& warnings) {
  const std::string one = fmt::format("{} angle", what), all = one + "s";
  std::vector<double> angles;
  for (size_t i = 0; i < count; ++i)
    angles.push_back(text.number(one.c_str(), least - angle_slack_deg, most + angle_slack_deg));
  check_monotonic(angles, text, all.c_str());
  snap_ends(angles, all.c_str(), path, warnings);
  for (const double a : angles)
    if (a < least || a > most)
      text.fail(fmt::format("{}: {} does not lie between {} and {}", one, a, least, most));
  return angles;
}

Planes read_planes(PhotometricText& text, const Header& h, const std::string& path,
                   WarningLog& warnings) {
  const bool is_round = h.type == 1;  // type C (1); types B (2) and A (3) are beams
  const double most_turn = is_round ? 360 : 90;
  Planes planes;
  planes.vertical_angles_deg = read_angles(text, h.heights, "vertical", is_round ? 0 : -90,
                                           is_round ? 180 : 90, path, warnings);
  planes.horizontal_angles_deg = read_angles(
      text, h.turns, "horizontal", -std::min(most_turn, 180.0), most_turn, path, warnings);
  for (size_t i = 0; i < h.heights * h.turns; ++i)
    planes.candela.push_back(h.factor * text.number("intensity", -most_candela, most_candela));
  reverse_descending_angles(planes, path, warnings);
  return planes;
}

Luminaire read_text(const std::string& path, PhotometricText& text, const std::string& folder,
                    WarningLog& warnings) {
  Luminaire l;
  Labels labels;
  const std::string tilt(read_labels(text, labels));
  l.description = labels.description;
  const std::string tilt_name = upper_case(tilt);
  if (tilt_name == "INCLUDE")
    l.tilt = read_tilt(text);
  else if (tilt_name != "NONE" && !tilt.empty())
    l.tilt = read_tilt_file(path, folder, tilt, warnings);
  const Header h = read_header(text, l, labels.edition, path, warnings);
  Planes planes = read_planes(text, h, path, warnings);
  if (h.has_zero_factor) warnings.add(path + ": factors of 0 are read as 1");
  clean_intensities(planes, text, path, warnings);
  warn_of_extra_numbers(text, path, warnings);
  if (h.type == 1)
    extend_to_poles(planes, path, warnings);
  else
    extend_to_beam_axis(planes, path, warnings);
  l.web = h.type == 1
              ? unfold_planes(planes, path, warnings)
              : unfold_beam(planes, h.type == 2 ? WebPole::right : WebPole::up, path, warnings);
  return l;
}

// True if a comma stands between two digits, so that it may be a decimal point.
bool has_commas_in_numbers(std::string_view bytes) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (size_t i = bytes.find(','); i != bytes.npos; i = bytes.find(',', i + 1))
    if (i > 0 && i + 1 < bytes.size() && is_digit(bytes[i - 1]) && is_digit(bytes[i + 1]))
      return true;
  return false;
}

}  // namespace

// Commas separate numbers, as the standard has it. If the file is not valid that way, commas are
// tried as decimal points.
Luminaire read_ies(const std::string& path, std::string_view bytes, const std::string& folder,
                   WarningLog& warnings) {
  WarningLog own;
  const auto finish = [&](Luminaire l) {
    for (const Warning& w : own.entries()) warnings.add(w.text, w.count);
    return l;
  };
  try {
    PhotometricText text(path, bytes);
    return finish(read_text(path, text, folder, own));
  } catch (const InputError&) {
    if (!has_commas_in_numbers(bytes)) throw;
    own = {};
    try {
      PhotometricText text(path, bytes, true);
      return finish(read_text(path, text, folder, own));
    } catch (const InputError&) {  // report the error of the standard reading
    }
    throw;
  }
}

}  // namespace troffer
