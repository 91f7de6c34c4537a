// Function files that come with Radiance, rewritten from their documentation. Both skies fade into
// the ground's brightness at the horizon: sky and ground are weighted by (Dz + 1.01)^10 and its
// inverse, and so have equal parts at Dz = -0.01.
//
// References: [1] manual pages gensky(1), gendaylit(1), and what these print; [2] CIE S 003:1996,
//   "Spatial distribution of daylight: CIE standard overcast sky and clear sky"; [3] Matsuura &
//   Iwata, "A model of daylight source for the daylight illuminance calculations on the all
//   weather conditions", 1990 (intermediate sky); [4] Perez, Seals & Michalsky, "All-weather model
//   for sky luminance distribution", Solar Energy 50(3), 1993, Eq. 1; [5] Diakite-Kortlever &
//   Knoop, "Forecast accuracy of existing luminance-related spectral sky models", 2021.
#include "import/radiance/radiance_cal.h"

namespace troffer {

namespace {

// gensky: A1 kind; brightness A2 of the zenith, A3 of the ground; A4 factor; A5 A6 A7 to the sun.
constexpr std::string_view skybright = R"(
  over_ground = (Dz + 1.01)^10;
  cos_sun = Dx*A5 + Dy*A6 + Dz*A7;
  from_sun = Acos(cos_sun);
  from_zenith = Acos(Dz);
  sun_from_zenith = Acos(A7);
  clear = A2/A4 * (.91 + 10*exp(-3*from_sun) + .45*cos_sun*cos_sun)
          * if(Dz - .01, 1 - exp(-.32/Dz), 1);
  overcast = A2/3 * (1 + 2*Dz);
  uniform = A2;
  intermediate = A2/A4/2.326
      * ((3.12 + 1.35*sin(5.631 - 3.59*from_zenith)) * sin(4.396 - 2.6*sun_from_zenith)
         + 6.37 - from_zenith)
      * exp(-.563*from_sun * ((2.629 - from_zenith)*(1.562 - sun_from_zenith) + .812));
  skybr = (over_ground*select(A1, clear, overcast, uniform, intermediate) + A3/over_ground)
          / (over_ground + 1/over_ground);
  skybright = skybr;
)";

// gendaylit: A1 factor on the sky; A2 brightness of the ground; A3 to A7 the model's a to e; A8 A9
// A10 to the sun.
constexpr std::string_view perezlum = R"(
  over_ground = (Dz + 1.01)^10;
  cos_sun = Dx*A8 + Dy*A9 + Dz*A10;
  sky = A1 * (1 + A3*Exp(A4/max(Dz, .01)))
           * (1 + A5*Exp(A6*Acos(cos_sun)) + A7*cos_sun*cos_sun);
  skybright = (over_ground*sky + A2/over_ground) / (over_ground + 1/over_ground);
)";

// gendaylit in colour: A11 clearness; A12 to A22 coefficients of chromaticity by colour
// temperature. Unless the sky is overcast, the temperature follows from the luminance.
constexpr std::string_view perezlum_colour = R"(
  temperature = if(1.065 - arg(11), 6191, 1e6 / (78.648*log10(skybright) - 180.956));
  cubic(i) = ((arg(i)/temperature + arg(i+1))/temperature + arg(i+2))/temperature + arg(i+3);
  x_chroma = if(temperature - 7000, cubic(16), cubic(12));
  y_chroma = (arg(20)*x_chroma + arg(21))*x_chroma + arg(22);
  cie_x = skybright*x_chroma/y_chroma;
  cie_z = skybright*(1 - x_chroma - y_chroma)/y_chroma;
  skybright_r =  2.5693*cie_x - 1.1668*skybright - .3984*cie_z;
  skybright_g = -1.0221*cie_x + 1.9783*skybright + .0438*cie_z;
  skybright_b = -.0747*cie_x - .2519*skybright + 1.1772*cie_z;
)";

constexpr std::string_view common = R"(
  AC = arg(0);
  A1 = arg(1); A2 = arg(2); A3 = arg(3); A4 = arg(4); A5 = arg(5);
  A6 = arg(6); A7 = arg(7); A8 = arg(8); A9 = arg(9); A10 = arg(10);
  D(i) = select(i, Dx, Dy, Dz);
  N(i) = select(i, Nx, Ny, Nz);
  P(i) = select(i, Px, Py, Pz);
  PI : 3.14159265358979323846; DEGREE : PI/180; FTINY : 1e-7;
  bound(least, x, most) : if(least - x, least, if(x - most, most, x));
  Acos(x) : acos(bound(-1, x, 1));
  Asin(x) : asin(bound(-1, x, 1));
  Atan2(y, x) : if(x*x + y*y, atan2(y, x), 0);
  Exp(x) : if(-x - 100, 0, exp(x));
  Sqrt(x) : if(x, sqrt(x), 0);
  and(a, b) : if(a, b, a);
  or(a, b) : if(a, a, b);
  not(a) : if(a, -1, 1);
  xor(a, b) : if(a, not(b), b);
  abs(x) : max(x, -x);
  sgn(x) : if(x, 1, if(-x, -1, 0));
  sq(x) : x*x;
  inside(a, x, b) : and(x - a, b - x);
  frac(x) : x - floor(x);
  mod(n, d) : n - floor(n/d)*d;
  tri(n, d) : abs(d - mod(n - d, 2*d));
  linterp(t, from, to) : from + t*(to - from);
  noop(v) : v;
  clip(v) : bound(0, v, 1);
  noneg(v) : max(v, 0);
  red(r, g, b) : max(r, 0);
  green(r, g, b) : max(g, 0);
  blue(r, g, b) : max(b, 0);
  grey(r, g, b) : noneg(.265074126*r + .670114631*g + .064811243*b);
  clip_r(r, g, b) : clip(r);
  clip_g(r, g, b) : clip(g);
  clip_b(r, g, b) : clip(b);
  clipgrey(r, g, b) : min(grey(r, g, b), 1);
  dot(v, w) : v(1)*w(1) + v(2)*w(2) + v(3)*w(3);
  cross(i, v, w) : select(i, v(2)*w(3) - v(3)*w(2), v(3)*w(1) - v(1)*w(3),
                          v(1)*w(2) - v(2)*w(1));
  flatness = Nx*Nx + Ny*Ny;
  U = if(flatness - FTINY, (Py*Nx - Px*Ny)/flatness, Px);
  V = if(flatness - FTINY, Pz - Nz*(Px*Nx + Py*Ny)/flatness, Py);
)";

}  // namespace

std::string_view radiance_common_definitions() {
  return common;
}

std::string_view radiance_library_file(std::string_view name) {
  static const std::string colour = std::string(perezlum) + std::string(perezlum_colour);
  if (name == "skybright.cal") return skybright;
  if (name == "perezlum.cal") return perezlum;
  if (name == "perezlum_c.cal") return colour;
  return "";
}

}  // namespace troffer
