// Measured luminaires: IES LM-63 and EULUMDAT files.
//
// References: [1] ANSI/IES LM-63-19 and its editions of 1986 to 2002, "Standard file format for the
//   electronic transfer of photometric data".
//   [2] Stockmar, "EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner",
//   Tagungsband Licht '90, 1990.
#pragma once

#include <string>

#include "base/log.h"
#include "scene/light_web.h"

namespace troffer {

struct Luminaire {
  // Luminous intensities, cd; heights from the nadir, turns from the C0 plane.
  LightWeb web;
  std::string description;
  double lamp_lumens = 0;  // stated; 0 where the file states none (absolute photometry)
  double watts = 0;
  double width = 0, length = 0, height = 0;  // of the luminous opening, m; round: width alone
  bool is_round = false;
};

// By ending: .ldt is EULUMDAT, all else LM-63 (type C). Repeats planes that symmetry leaves out.
// Warnings: what is odd but has a meaning (decimal commas, planes that do not close, negative
// intensities). InputError with line and column: what has none, types A and B, and files of more
// than 4 Mi values or 64 MiB.
Luminaire read_luminaire(const std::string& path, WarningLog& warnings);

}  // namespace troffer
