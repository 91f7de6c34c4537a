#include "annual/year_skies.h"

#include <algorithm>

#include "annual/outside_sources.h"
#include "annual/sun_grid.h"
#include "base/parallel.h"
#include "base/units.h"
#include "daylight/sky_model.h"

namespace troffer {

YearSkies make_year_skies(const WeatherYear& year, int subdivision, double ground_reflectance,
                          int threads) {
  YearSkies out{
      {}, {ReinhartSky(reflected_subdivision), {}}, {ReinhartSky(subdivision), {}}, {}, {}, {}};
  for (size_t i = 0; i < year.steps.size(); ++i)
    if (year.steps[i].sun.altitude_deg > 0) out.steps.push_back(uint32_t(i));
  const size_t n = out.hours();
  for (PatchHours* p : {&out.coarse, &out.fine}) p->luminance.assign(p->sky.size() * n, 0);
  for (std::vector<float>* v : {&out.ground, &out.sun_lx, &out.diffuse_lx}) v->assign(n, 0);
  parallel_for(n, threads, [&](size_t h) {
    const WeatherStep& step = year.steps[out.steps[h]];
    if (!(step.direct_normal + step.diffuse_horizontal > 0)) return;
    const double zenith = rad_from_deg(90 - step.sun.altitude_deg);
    const PerezSky sky =
        perez_sky(step.direct_normal, step.diffuse_horizontal, zenith, step.sun.distance_au);
    const Vec3d to_sun = direction_of(step.sun);
    std::vector<float> luminances(std::max(out.fine.sky.size(), out.coarse.sky.size()));
    for (PatchHours* hours : {&out.coarse, &out.fine}) {
      patch_luminances(hours->sky, sky.shape, to_sun, sky.diffuse_lx,
                       int(hours->sky.strata_per_side()),
                       std::span(luminances).first(hours->sky.size()));
      for (size_t p = 0; p < hours->sky.size(); ++p) hours->luminance[p * n + h] = luminances[p];
    }
    if (has_sunshine(step)) out.sun_lx[h] = float(sky.direct_lx);
    out.diffuse_lx[h] = float(sky.diffuse_lx);
    const double global = sky.diffuse_lx + double(out.sun_lx[h]) * to_sun.z;
    out.ground[h] = float(ground_reflectance * global / pi);
  });
  return out;
}

}  // namespace troffer
