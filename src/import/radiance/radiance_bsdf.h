// Converts Radiance's BSDF and aBSDF materials, whose scattering is in an XML file
// (import/window_xml.h). Used by RadianceMaterials.
//
// References: [1] Radiance, src/rt/m_bsdf.c (arguments).
#pragma once

#include <string>

#include "import/radiance/radiance_pattern.h"
#include "scene/scene.h"

namespace troffer {

// Strings: thickness (BSDF only), file, up vector, function file, transform. Reals: diffuse
// reflectance of front and back, and transmittance, each r g b, added to the file's. The file is
// looked up in `folder`. A file that cannot be found is a warning, and the material is grey. Throws
// InputError for missing arguments and malformed files.
Material radiance_bsdf(const RadianceModifier& m, const std::string& folder, WarningLog& warnings);

}  // namespace troffer
