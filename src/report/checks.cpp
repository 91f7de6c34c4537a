#include "report/checks.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

Check check(const std::string& subject, const Profile& p, const char* quantity, const char* unit,
            double required, const Figure& value) {
  Check c{subject, p.id, quantity, unit, required, false, value, Verdict::open};
  c.is_most = c.quantity == "UGR";
  c.verdict = verdict_of(value, required, c.is_most);
  return c;
}

// task: the profile whose UGR limit applies to surroundings of tasks; null if there is none.
void check_surface(const Assessment& a, size_t i, const Profile& p, const Profile* task,
                   std::vector<Check>& out) {
  const SurfaceResult& s = a.surfaces[i];
  const GridSummary sums = summary_of(assessed_light(s));
  if (sums.has_values && p.illuminance_lx > 0)
    out.push_back(check(s.surface.name, p, "Ēm", "lx", p.illuminance_lx, sums.mean));
  if (sums.has_values && p.uniformity > 0)
    out.push_back(check(s.surface.name, p, "U0", "", p.uniformity, sums.uniformity));
  const Glare* worst = worst_glare(a, i);
  const Profile& limit = p.is_around_task && !(p.ugr_limit > 0) && task != nullptr ? *task : p;
  if (worst != nullptr && limit.ugr_limit > 0)
    out.push_back(check(s.surface.name, limit, "UGR", "", limit.ugr_limit, worst->ugr));
}

void check_cylinders(const Assessment& a, const Profile& p, std::vector<Check>& out) {
  if (!(p.cylindrical_lx > 0)) return;
  for (size_t f = 0; f < a.floors.size(); ++f) {
    std::vector<Figure> values;
    for (const CylinderResult& c : a.cylinders)
      if (c.floor == f) values.push_back(c.cylindrical);
    if (values.empty()) continue;
    const GridSummary sums = summary_of(values);
    constexpr double uniformity = 0.1;  // EN 12464-1, 4.6.2
    out.push_back(check(a.floors[f].name, p, "Ēz", "lx", p.cylindrical_lx, sums.mean));
    out.push_back(check(a.floors[f].name, p, "U0 of Ez", "", uniformity, sums.uniformity));
  }
}

}  // namespace

Verdict verdict_of(const Figure& value, double required, bool is_most) {
  const double reserve = is_most ? required - value.value : value.value - required;
  if (value.error > 0 && reserve < 2 * value.error && reserve > -2 * value.error)
    return Verdict::open;
  return reserve >= 0 ? Verdict::pass : Verdict::fail;
}

std::optional<double> samples_to_decide(const Check& c, double samples) {
  if (c.verdict != Verdict::open) return std::nullopt;
  const double reserve = std::abs(c.required - c.value.value);
  constexpr double most = 1e9;  // limit on samples per point; beyond it the value practically
                                // equals the requirement
  const double factor = 2 * c.value.error / std::max(reserve, 1e-300);
  return samples * factor * factor < most ? std::optional(samples * factor * factor) : std::nullopt;
}

const Glare* worst_glare(const Assessment& a, size_t surface) {
  const Glare* worst = nullptr;
  for (const GlareResult& g : a.glares)
    if (g.surface == surface && g.glare.is_defined &&
        (worst == nullptr || g.glare.ugr.value > worst->ugr.value))
      worst = &g.glare;
  return worst;
}

std::vector<Check> checks_of(const Assessment& a, const std::vector<Profile>& profiles,
                             const std::string& profile) {
  std::vector<Check> checks;
  const Profile* p = find_profile(profiles, profile);
  for (size_t i = 0; i < a.surfaces.size(); ++i)
    if (const Profile* own = find_profile(profiles, a.surfaces[i].surface.profile))
      check_surface(a, i, *own, p, checks);
  if (p == nullptr) return checks;
  const Glare* worst = worst_glare(a, no_surface);
  if (worst != nullptr && p->ugr_limit > 0)
    checks.push_back(check("observers", *p, "UGR", "", p->ugr_limit, worst->ugr));
  check_cylinders(a, *p, checks);
  return checks;
}

}  // namespace troffer
