// Gauss-Legendre quadrature on [0,1]: exact for polynomials up to degree 5 with three points.
//
// References: [1] Abramowitz and Stegun, "Handbook of Mathematical Functions", table 25.4.
#pragma once

#include <array>

namespace troffer {

template <class T>
inline constexpr std::array<T, 3> gauss_nodes{T(0.11270166537925831), T(0.5),
                                              T(0.88729833462074169)};
template <class T>
inline constexpr std::array<T, 3> gauss_weights{T(5) / 18, T(8) / 18, T(5) / 18};

}  // namespace troffer
