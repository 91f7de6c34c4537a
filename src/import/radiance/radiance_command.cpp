#include "import/radiance/radiance_command.h"

#include <array>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

constexpr size_t max_copies = 100'000;

class XformParser {
 public:
  XformParser(const std::vector<std::string>& words, const SourcePlace& place)
      : words_(words), place_(place) {}
  RadianceXform parse();

 private:
  const std::vector<std::string>& words_;
  const SourcePlace& place_;
  size_t at_ = 0;
  RadianceXform out_;
  Affine step_;         // transform of the part that is being read
  size_t repeats_ = 1;  // repetitions of that part
  bool is_array_ = false;

  double number() { return radiance_number(word(), place_); }
  std::string word() {
    if (at_ >= words_.size()) place_.fail("xform: an argument is missing");
    return words_[at_++];
  }
  size_t count() {
    const double n = number();
    if (!(n >= 1 && n <= double(max_copies)) || n != std::floor(n))
      place_.fail("xform: a number of copies from 1 to 100000 expected");
    return size_t(n);
  }
  void finish_part();
  void option(const std::string& name);
  void then(const Affine& t) { step_ = t * step_; }
};

// Ends a part: applies it `repeats_` times to all copies, or with -a makes a copy for each count
// from 0.
void XformParser::finish_part() {
  if (is_array_ && out_.copies.size() * repeats_ > max_copies)
    place_.fail("xform: more than 100000 copies");
  const std::vector<Affine> before = out_.copies;
  std::vector<Affine> all;
  Affine power;
  for (size_t i = 0; i < repeats_; ++i) {
    if (is_array_)
      for (const Affine& t : before) all.push_back(power * t);
    power = step_ * power;
  }
  if (!is_array_)
    for (const Affine& t : before) all.push_back(power * t);
  out_.copies = std::move(all);
  step_ = Affine();
  repeats_ = 1;
  is_array_ = false;
}

void XformParser::option(const std::string& name) {
  if (name == "-t") {
    const double x = number(), y = number();
    then(Affine::translate({x, y, number()}));
  } else if (name == "-rx" || name == "-ry" || name == "-rz") {
    Vec3d axis;
    axis[size_t(name[2] - 'x')] = 1;
    then(Affine::rotate(rad_from_deg(number()), axis));
  } else if (name == "-s") {
    then(Affine::scale(Vec3d{number()}));
  } else if (name == "-mx" || name == "-my" || name == "-mz") {
    Vec3d scale{1};
    scale[size_t(name[2] - 'x')] = -1;
    then(Affine::scale(scale));
  } else if (name == "-a" || name == "-i") {
    finish_part();
    repeats_ = count();
    is_array_ = name == "-a";
  } else if (name == "-m") {
    out_.modifier = word();
  } else if (name == "-n") {
    word();
  } else if (name == "-I") {
    out_.is_inverted = true;
  } else if (name != "-c" && name != "-e") {
    place_.fail("xform: the option '" + shortened(name) + "' is not supported");
  }
}

RadianceXform XformParser::parse() {
  while (at_ < words_.size()) {
    const std::string next = word();
    if (next.starts_with('-') && next.size() > 1) {
      option(next);
    } else {
      out_.files.push_back(next);
    }
  }
  finish_part();
  return std::move(out_);
}

}  // namespace

RadianceXform parse_xform(const std::vector<std::string>& words, const SourcePlace& place) {
  return XformParser(words, place).parse();
}

RadianceBox parse_genbox(const std::vector<std::string>& words, const SourcePlace& place) {
  if (words.size() < 5) place.fail("genbox needs a material, a name and three sizes");
  RadianceBox box;
  box.modifier = words[0];
  Vec3d size;
  for (size_t a = 0; a < 3; ++a) {
    size[a] = radiance_number(words[2 + a], place);
    if (!(size[a] > 0)) place.fail("genbox: sizes must be positive");
  }
  bool is_inward = false;
  for (size_t i = 5; i < words.size(); ++i) {
    if (words[i] == "-i") {
      is_inward = true;
    } else if (words[i] == "-r" || words[i] == "-b") {
      box.is_simplified = true;
      ++i;
    } else if (words[i] != "-n" && words[i] != "-o") {
      place.fail("genbox: the option '" + shortened(words[i]) + "' is not supported");
    }
  }
  for (size_t a = 0; a < 3; ++a) {
    for (const bool is_far : {false, true}) {
      std::vector<Vec3d> corners;
      constexpr std::array<std::array<bool, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
      for (size_t k = 0; k < 4; ++k) {
        const auto& c = around[is_far != is_inward ? k : 3 - k];
        Vec3d p;
        p[a] = is_far ? size[a] : 0;
        p[(a + 1) % 3] = c[0] ? size[(a + 1) % 3] : 0;
        p[(a + 2) % 3] = c[1] ? size[(a + 2) % 3] : 0;
        corners.push_back(p);
      }
      box.polygons.push_back(std::move(corners));
    }
  }
  return box;
}

}  // namespace troffer
