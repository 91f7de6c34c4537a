// Choice between gathers and paths that end at cells for a whole picture (methods/gather_trial.h).
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns the decision between gathers and cached paths.
PlannedPart decision_of(const RenderResult& r) {
  for (const PlannedPart& p : r.statistics.plan.parts)
    if (p.part == "paths that end at cells") return p;
  return {};
}

// Renders a matte room with a lamp in view.
RenderResult matte_room(int width, int height, float error) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 1, 2.4f, Rgb{10});
  const PreparedScene scene(std::move(s));
  RenderOptions o;
  o.indirect = Indirect::automatic;
  o.error = error;
  o.width = width;
  o.height = height;
  o.threads = 2;
  return render_now(scene, look_at({-1.8f, -1.8f, 1}, {0.5f, 0.5f, 1.8f}, {0, 0, 1}, 70), o);
}

}  // namespace

TEST_CASE("gathers: what surrogate samples resolve does not count as noise") {
  // The outline of the lamp varies within many pixels, but surrogate samples resolve it.
  const RenderResult r = matte_room(128, 96, 0.1f);
  const PlannedPart decision = decision_of(r);
  REQUIRE(decision.reason.find("gathers") != std::string::npos);
  CHECK(decision.choice == "no");
  // The trial forecasts what gathers and viewing rays take: within a factor of three.
  const double forecast =
                   std::stod(decision.reason.substr(decision.reason.find("gathers") + 8)) * 1e6,
               actual = double(r.statistics.counters.viewing_rays +
                               r.statistics.counters.extension_rays);
  CHECK(forecast < 3 * actual);
  CHECK(forecast > actual / 3);
}

TEST_CASE("gathers: small pictures, too, compare them with cached paths") {
  CHECK(decision_of(matte_room(32, 24, 0.02f)).reason.find("gathers") != std::string::npos);
}
