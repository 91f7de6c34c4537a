// Measured luminaires that take the place of parts of a scene: --luminaire.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "import/luminaire/luminaire.h"
#include "scene/scene.h"

namespace troffer {

// read_luminaire(); a further warning where the intensities add up to 5 % more than the lamps are
// said to have, or to something else than what of that leaves the luminaire (EULUMDAT).
Luminaire read_and_check_luminaire(const std::string& path, WarningLog& warnings);

// What intensities are multiplied by in the scene's unit, so that the flux is `lumens` (0: the
// file's), in the colour of a black body (0: white). UsageError where the file, whose name is for
// the message, has too little light for that.
Rgb luminaire_scale(const Scene& scene, const Luminaire& luminaire, const std::string& name,
                    double lumens, double kelvin);

// Each "NODE=FILE[,LUMENS[,KELVIN]]"; a NODE with '*' stands for all lights that it fits, or, where
// no light does, surfaces (base/wildcard.h). UsageError for what cannot be read so and for nodes
// that cannot shine so; InputError for files.
void attach_luminaires(Scene& scene, const std::vector<std::string>& luminaires, const Vec3& down);

// The node of each such option (it may hold '*'), and what its luminaire takes by the file, W: 0
// where that states nothing.
std::vector<std::pair<std::string, double>> watts_of_luminaires(
    const std::vector<std::string>& luminaires);

}  // namespace troffer
