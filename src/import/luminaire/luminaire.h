// Photometric files of luminaires: IES LM-63 and EULUMDAT. A Luminaire holds the photometric web
// (cd), the luminous opening (m) and the lamps' data. attach_luminaire.h puts it into a scene.
// docs/reference/luminaires.md describes both from the user's side.
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

// Factors on the light of a luminaire that is tilted together with its lamp.
struct TiltFactors {
  std::vector<double> angles_deg, factors;  // lists of equal size; empty: factor 1
};

// Content of a photometric file.
struct Luminaire {
  // Luminous intensities, cd.
  LightWeb web;
  std::string description;
  double lamp_lumens = 0;    // 0: not stated (absolute photometry)
  double output_ratio = 0;   // share of lamp_lumens that leaves the luminaire; 0: not stated
  bool is_absolute = false;  // the file declares absolute photometry: -1 lumens (LM-63) or lamps
                             // (EULUMDAT)
  double watts = 0;          // 0: not stated
  LuminousOpening opening;
  TiltFactors tilt;
};

// Reads a file: .ldt is EULUMDAT, any other ending LM-63. Repeats the planes that symmetry omits.
// Reads a file of tilt factors that TILT= names, if it lies in the same folder.
// Warns of unusual content with a clear meaning: decimal commas, planes that do not close, negative
// intensities, descending angles, a missing pole, factors of 0.
// Throws InputError with line and column for content without a clear meaning, and for files of more
// than 4 Mi values or 64 MiB.
Luminaire read_luminaire(const std::string& path, WarningLog& warnings);
// Reads LM-63 text that is not a file of its own; `name` replaces the path in messages. Files of
// tilt factors are not read.
Luminaire read_luminaire_text(const std::string& name, std::string_view text, WarningLog& warnings);

// Returns the factor at `tilt_deg`, the angle between the nadir and straight down; linear between
// the listed angles, constant beyond.
double tilt_factor(const Luminaire& luminaire, double tilt_deg);

}  // namespace troffer
