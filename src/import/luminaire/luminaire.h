// Measured luminaires: IES LM-63 and EULUMDAT files.
//
// References: [1] ANSI/IES LM-63-19 and its editions of 1986 to 2002, "Standard file format for the
//   electronic transfer of photometric data".
//   [2] Stockmar, "EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner",
//   Tagungsband Licht '90, 1990.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/log.h"
#include "import/luminaire/luminous_opening.h"
#include "scene/light_web.h"

namespace troffer {

constexpr size_t max_luminaire_bytes = size_t(64) << 20;

// By what a luminaire's light is multiplied that is tilted, its lamp with it.
struct TiltFactors {
  std::vector<double> angles_deg, factors;  // as many; empty: 1
};

struct Luminaire {
  // Luminous intensities, cd.
  LightWeb web;
  std::string description;
  double lamp_lumens = 0;    // stated; 0 where the file states none (absolute photometry)
  double output_ratio = 0;   // … what share of them leaves the luminaire; 0: the file states none
  bool is_absolute = false;  // photometry that says so: -1 lumens, or lamps, in the file
  double watts = 0;          // 0: the file states none
  LuminousOpening opening;
  TiltFactors tilt;
};

// By ending: .ldt is EULUMDAT, all else LM-63. Repeats planes that symmetry leaves out. Factors of
// a file that LM-63's TILT names are read from beside it.
// Warnings: what is odd but has a meaning (decimal commas, planes that do not close, negative
// intensities, angles that descend or leave out a pole, factors of 0). InputError with line and
// column: what has none, and files of more than 4 Mi values or 64 MiB.
Luminaire read_luminaire(const std::string& path, WarningLog& warnings);
// The same of LM-63 text that is no file; `name` stands for its path in messages.
Luminaire read_luminaire_text(const std::string& name, std::string_view text, WarningLog& warnings);

// Of a luminaire whose nadir is so far from straight down; linear between the angles it gives.
double tilt_factor(const Luminaire& luminaire, double tilt_deg);

}  // namespace troffer
