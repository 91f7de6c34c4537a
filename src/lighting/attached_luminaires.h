// --luminaire: measured luminaires that replace parts of a scene. add_daylight() and the list of
// luminaires (luminaire_list.h) use it. Fluxes are in lm, colour temperatures in K, powers in W.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "import/luminaire/luminaire.h"
#include "scene/scene.h"

namespace troffer {

// Returns read_luminaire() and checks its flux. Warns if the intensities give over 5 % more flux
// than the lamps. If the file states a light output ratio (EULUMDAT), it warns if they differ by
// over 5 % from that share of the lamps' flux.
Luminaire read_and_check_luminaire(const std::string& path, WarningLog& warnings);

// Returns the factor on the intensities in the scene's unit. The luminaire then has the flux
// `lumens` (0: that of the file) and the colour of a black body of `kelvin` (0: white). `name` is
// used in the message. Throws UsageError if the luminaire has too little light for that flux.
Rgb luminaire_scale(const Scene& scene, const Luminaire& luminaire, const std::string& name,
                    double lumens, double kelvin);

// Attaches luminaires, each given as "NODE=FILE[,LUMENS[,KELVIN]]". A NODE with '*'
// (base/wildcard.h) stands for all lights that match or, if none does, all surfaces. Throws
// UsageError for malformed texts and for nodes that cannot emit this way, InputError for files.
void attach_luminaires(Scene& scene, const std::vector<std::string>& luminaires, const Vec3& down);

// Returns the node of each option (it may contain '*') and the power that its file states in W; 0
// if the file states none.
std::vector<std::pair<std::string, double>> watts_of_luminaires(
    const std::vector<std::string>& luminaires);

}  // namespace troffer
