// Matrices of directional scattering for tests, and files with them.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <string>

#include "base/units.h"
#include "scene/angular_bsdf.h"

namespace troffer::test {

// A matrix with value(out, in) of two patches.
inline AngleMatrix matrix_of(const AngleBasis& basis,
                             const std::function<double(size_t, size_t)>& value) {
  AngleMatrix m{basis, basis, {}};
  for (size_t o = 0; o < basis.size(); ++o)
    for (size_t i = 0; i < basis.size(); ++i) m.values.push_back(float(value(o, i)));
  return m;
}

// Scatters the share `diffuse` evenly, and sends `straight` × the cosine of the patch's middle
// along the diagonal.
inline AngleMatrix peaked_matrix(const AngleBasis& basis, double diffuse, double straight) {
  return matrix_of(basis, [&](size_t o, size_t i) {
    const double peak = o == i ? straight * double(basis.direction(o, {0.5f, 0.5f}).z) /
                                     basis.projected_solid_angle(o)
                               : 0;
    return diffuse / pi + peak;
  });
}

// Irradiance behind a layer as wide as the sky under a uniform sky of radiance 1:
// Σ_o Σ_i M Ω_o Ω_i.
inline double sky_through(const AngleMatrix& m) {
  double sum = 0;
  for (size_t i = 0; i < m.in.size(); ++i)
    sum += m.hemispherical(i) * m.in.projected_solid_angle(i);
  return sum;
}

// The blocks of angle definitions of a basis, as LBNL's schema has them.
inline std::string basis_xml(const AngleBasis& basis, const std::string& name) {
  std::string text = "<AngleBasis><AngleBasisName>" + name + "</AngleBasisName>\n";
  for (size_t r = 0; r < basis.rings(); ++r)
    text += fmt::format(
        "<AngleBasisBlock><Theta>0</Theta><nPhis>{}</nPhis><ThetaBounds><LowerTheta>{}</LowerTheta>"
        "<UpperTheta>{}</UpperTheta></ThetaBounds></AngleBasisBlock>\n",
        basis.all_rings()[r].patches, basis.all_rings()[r].theta_deg,
        r + 1 < basis.rings() ? basis.all_rings()[r + 1].theta_deg : 90.0);
  return text + "</AngleBasis>\n";
}

inline std::string block_xml(const std::string& way, const std::string& basis,
                             const std::string& data) {
  return "<WavelengthData><LayerNumber>System</LayerNumber><Wavelength "
         "unit=\"Integral\">Visible</Wavelength><WavelengthDataBlock>"
         "<WavelengthDataDirection>" +
         way + "</WavelengthDataDirection><ColumnAngleBasis>" + basis +
         "</ColumnAngleBasis><RowAngleBasis>" + basis + "</RowAngleBasis><AngleBasis>" + basis +
         "</AngleBasis><ScatteringDataType>BTDF</ScatteringDataType><ScatteringData>\n" + data +
         "</ScatteringData></WavelengthDataBlock></WavelengthData>\n";
}

inline std::string window_xml(const std::string& structure, const std::string& basis,
                              const std::string& blocks) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<WindowElement "
         "xmlns=\"http://windows.lbl.gov\">\n<Optical><Layer><Material><Name>test</Name></Material>"
         "<DataDefinition><IncidentDataStructure>" +
         structure + "</IncidentDataStructure>" + basis + "</DataDefinition>\n" + blocks +
         "</Layer></Optical></WindowElement>\n";
}

// A file with the matrices by their directions, such as "Transmission Front".
inline std::string klems_file(const std::map<std::string, AngleMatrix>& ways,
                              const std::string& name = "LBNL/Klems Full") {
  std::string blocks;
  for (const auto& [way, m] : ways) {
    std::string data;
    for (size_t k = 0; k < m.values.size(); ++k)
      data += fmt::format("{}{}", m.values[k], (k + 1) % m.in.size() == 0 ? "\n" : ",");
    blocks += block_xml(way, name, data);
  }
  return window_xml("Columns", basis_xml(ways.begin()->second.in, name), blocks);
}

}  // namespace troffer::test
