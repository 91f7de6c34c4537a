// Complex indices of Mitsuba's named metals, as in its rgb modes: eta and k of its tables. Each is
// reduced to linear sRGB like an emission spectrum (import/mitsuba/mitsuba_spectrum.h). Beyond the
// end of a table the values count as zero, as in Mitsuba.
//
// References: [1] Palik (ed.), "Handbook of Optical Constants of Solids", Academic Press, 1985 and
//   1991. [2] W. Jakob et al., "Mitsuba 3 documentation: BSDFs" (conductor: names of materials).
#include <array>

#include "import/mitsuba/mitsuba_spectrum.h"

namespace troffer {

namespace {

struct MitsubaMetal {
  std::string_view name;
  Rgb eta, k;
};
constexpr std::array mitsuba_metals{
    MitsubaMetal{"a-C", {2.94405f, 2.22714f, 1.96816f}, {0.887465f, 0.799298f, 0.81529f}},
    MitsubaMetal{"Ag", {0.155276f, 0.116728f, 0.138388f}, {4.82835f, 3.12222f, 2.1469f}},
    MitsubaMetal{"Al", {1.6575f, 0.880405f, 0.521244f}, {9.22381f, 6.2695f, 4.837f}},
    MitsubaMetal{"AlAs", {3.6053f, 3.23294f, 2.21632f}, {0.000679437f, 0, 0.00751271f}},
    MitsubaMetal{"AlAs_palik", {3.6053f, 3.23294f, 2.21632f}, {0.000679437f, 0, 0.00751271f}},
    MitsubaMetal{"AlSb", {0, 4.13937f, 4.66925f}, {0, 0.0940091f, 1.30057f}},
    MitsubaMetal{"AlSb_palik", {0, 4.13937f, 4.66925f}, {0, 0.0940091f, 1.30057f}},
    MitsubaMetal{"Au", {0.143036f, 0.375307f, 1.44205f}, {3.983f, 2.38556f, 1.60336f}},
    MitsubaMetal{"Be", {4.18501f, 3.18503f, 2.78406f}, {3.83547f, 3.01012f, 2.86899f}},
    MitsubaMetal{"Be_palik", {4.18501f, 3.18503f, 2.78406f}, {3.83547f, 3.01012f, 2.86899f}},
    MitsubaMetal{"Cr", {4.36967f, 2.91651f, 1.6549f}, {5.20655f, 4.23131f, 3.7547f}},
    MitsubaMetal{"CsI", {2.1449f, 1.70232f, 1.66243f}, {0, 0, 0}},
    MitsubaMetal{"CsI_palik", {2.1449f, 1.70232f, 1.66243f}, {0, 0, 0}},
    MitsubaMetal{"Cu", {0.201006f, 0.923749f, 1.10222f}, {3.91326f, 2.45305f, 2.14209f}},
    MitsubaMetal{"Cu2O", {3.55177f, 2.94987f, 2.75188f}, {0.114207f, 0.193897f, 0.606134f}},
    MitsubaMetal{"Cu2O_palik", {3.55177f, 2.94987f, 2.75188f}, {0.114207f, 0.193897f, 0.606134f}},
    MitsubaMetal{"Cu_palik", {0.213229f, 0.919715f, 1.10241f}, {3.92187f, 2.45733f, 2.13658f}},
    MitsubaMetal{"CuO", {3.24754f, 2.44781f, 2.21022f}, {0.52109f, 0.570031f, 0.722179f}},
    MitsubaMetal{"CuO_palik", {3.24754f, 2.44781f, 2.21022f}, {0.52109f, 0.570031f, 0.722179f}},
    MitsubaMetal{"d-C", {2.70872f, 2.31883f, 2.2289f}, {0, 0, 0}},
    MitsubaMetal{"d-C_palik", {2.70872f, 2.31883f, 2.2289f}, {0, 0, 0}},
    MitsubaMetal{"Hg", {2.39894f, 1.44003f, 0.90957f}, {6.32759f, 4.37192f, 3.42176f}},
    MitsubaMetal{"Hg_palik", {2.39894f, 1.44003f, 0.90957f}, {6.32759f, 4.37192f, 3.42176f}},
    MitsubaMetal{"HgTe", {4.77904f, 3.2312f, 2.6599f}, {1.63161f, 1.58081f, 1.72929f}},
    MitsubaMetal{"HgTe_palik", {4.77904f, 3.2312f, 2.6599f}, {1.63161f, 1.58081f, 1.72929f}},
    MitsubaMetal{"Ir", {3.0863f, 2.08219f, 1.61791f}, {5.59215f, 4.06709f, 3.26731f}},
    MitsubaMetal{"Ir_palik", {3.0863f, 2.08219f, 1.61791f}, {5.59215f, 4.06709f, 3.26731f}},
    MitsubaMetal{"K", {0.0640432f, 0.0464098f, 0.0381849f}, {2.1042f, 1.34894f, 0.913126f}},
    MitsubaMetal{"K_palik", {0.0640432f, 0.0464098f, 0.0381849f}, {2.1042f, 1.34894f, 0.913126f}},
    MitsubaMetal{"Li", {0.265791f, 0.195618f, 0.220949f}, {3.54016f, 2.31112f, 1.66861f}},
    MitsubaMetal{"Li_palik", {0.265791f, 0.195618f, 0.220949f}, {3.54016f, 2.31112f, 1.66861f}},
    MitsubaMetal{"MgO", {2.08958f, 1.65072f, 1.59488f}, {4.3327e-12f, 0, 2.49865e-11f}},
    MitsubaMetal{"MgO_palik", {2.08958f, 1.65072f, 1.59488f}, {4.3327e-12f, 0, 2.49865e-11f}},
    MitsubaMetal{"Mo", {4.48397f, 3.52513f, 2.77631f}, {4.11144f, 3.42083f, 3.15061f}},
    MitsubaMetal{"Mo_palik", {4.48397f, 3.52513f, 2.77631f}, {4.11144f, 3.42083f, 3.15061f}},
    MitsubaMetal{"Na_palik", {0.0602694f, 0.0561409f, 0.0619884f}, {3.17927f, 2.11249f, 1.57904f}},
    MitsubaMetal{"Nb", {3.42007f, 2.79009f, 2.39563f}, {3.44139f, 2.73767f, 2.57975f}},
    MitsubaMetal{"Nb_palik", {3.42007f, 2.79009f, 2.39563f}, {3.44139f, 2.73767f, 2.57975f}},
    MitsubaMetal{"Ni_palik", {2.3673f, 1.66337f, 1.46708f}, {4.49881f, 3.05015f, 2.34544f}},
    MitsubaMetal{"Rh", {2.58579f, 1.86022f, 1.55426f}, {6.78226f, 4.70299f, 3.97607f}},
    MitsubaMetal{"Rh_palik", {2.58579f, 1.86022f, 1.55426f}, {6.78226f, 4.70299f, 3.97607f}},
    MitsubaMetal{"Se", {4.05831f, 2.84293f, 2.82085f}, {0.75405f, 0.638444f, 0.521807f}},
    MitsubaMetal{"Se-e", {5.72285f, 4.16574f, 4.08134f}, {0.871136f, 1.10516f, 1.56532f}},
    MitsubaMetal{"Se-e_palik", {5.72285f, 4.16574f, 4.08134f}, {0.871136f, 1.10516f, 1.56532f}},
    MitsubaMetal{"Se_palik", {4.05831f, 2.84293f, 2.82085f}, {0.75405f, 0.638444f, 0.521807f}},
    MitsubaMetal{"SiC", {3.17234f, 2.52597f, 2.47937f}, {7.53766e-07f, 0, 1.01925e-05f}},
    MitsubaMetal{"SiC_palik", {3.17234f, 2.52597f, 2.47937f}, {7.53766e-07f, 0, 1.01925e-05f}},
    MitsubaMetal{"SnTe", {4.52425f, 1.98164f, 1.28159f}, {0, 0, 0}},
    MitsubaMetal{"SnTe_palik", {4.52425f, 1.98164f, 1.28159f}, {0, 0, 0}},
    MitsubaMetal{"Ta", {2.06272f, 2.39294f, 2.62793f}, {2.40836f, 1.74149f, 1.94703f}},
    MitsubaMetal{"Ta_palik", {2.06272f, 2.39294f, 2.62793f}, {2.40836f, 1.74149f, 1.94703f}},
    MitsubaMetal{"Te", {7.39023f, 4.4821f, 2.63711f}, {3.25602f, 3.52706f, 3.29205f}},
    MitsubaMetal{"Te-e", {7.50891f, 4.29643f, 2.36999f}, {5.58393f, 4.9472f, 3.99759f}},
    MitsubaMetal{"Te-e_palik", {7.50891f, 4.29643f, 2.36999f}, {5.58393f, 4.9472f, 3.99759f}},
    MitsubaMetal{"Te_palik", {7.39023f, 4.4821f, 2.63711f}, {3.25602f, 3.52706f, 3.29205f}},
    MitsubaMetal{"ThF4", {1.83071f, 1.44223f, 1.38765f}, {0, 0, 0}},
    MitsubaMetal{"ThF4_palik", {1.83071f, 1.44223f, 1.38765f}, {0, 0, 0}},
    MitsubaMetal{"TiC", {3.70053f, 2.83742f, 2.58229f}, {3.26564f, 2.35159f, 2.17279f}},
    MitsubaMetal{"TiC_palik", {3.70053f, 2.83742f, 2.58229f}, {3.26564f, 2.35159f, 2.17279f}},
    MitsubaMetal{"TiN", {1.64845f, 1.15052f, 1.37982f}, {3.36833f, 1.9435f, 1.10207f}},
    MitsubaMetal{"TiN_palik", {1.64845f, 1.15052f, 1.37982f}, {3.36833f, 1.9435f, 1.10207f}},
    MitsubaMetal{"TiO2", {3.45661f, 2.80174f, 2.90517f}, {0.000105265f, 0, 0.000652886f}},
    MitsubaMetal{"TiO2-e", {3.10656f, 2.51317f, 2.58244f}, {2.97516e-05f, 0, 0.000182698f}},
    MitsubaMetal{"TiO2-e_palik", {3.10656f, 2.51317f, 2.58244f}, {2.97516e-05f, 0, 0.000182698f}},
    MitsubaMetal{"TiO2_palik", {3.45661f, 2.80174f, 2.90517f}, {0.000105265f, 0, 0.000652886f}},
    MitsubaMetal{"V_palik", {4.27758f, 3.51295f, 2.76107f}, {3.4913f, 2.88945f, 3.11152f}},
    MitsubaMetal{"VC", {3.65757f, 2.75274f, 2.53267f}, {3.0683f, 2.19869f, 1.96319f}},
    MitsubaMetal{"VC_palik", {3.65757f, 2.75274f, 2.53267f}, {3.0683f, 2.19869f, 1.96319f}},
    MitsubaMetal{"VN", {2.8656f, 2.11919f, 1.94009f}, {3.03224f, 2.05612f, 1.61631f}},
    MitsubaMetal{"VN_palik", {2.8656f, 2.11919f, 1.94009f}, {3.03224f, 2.05612f, 1.61631f}},
    MitsubaMetal{"W", {4.37082f, 3.30025f, 2.99841f}, {3.50064f, 2.60487f, 2.27323f}},
};

}  // namespace

std::optional<MetalIndices> mitsuba_metal(std::string_view name) {
  for (const MitsubaMetal& row : mitsuba_metals)
    if (row.name == name) return MetalIndices{row.eta, row.k};
  return std::nullopt;
}

}  // namespace troffer
