// Answers the page's requests for a year of daylight: paths that begin with "year". ViewService
// uses it. Illuminance is in lx; bodies of numbers are little-endian floats.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "annual/stored_hours.h"
#include "base/box.h"
#include "transport/prepared_scene.h"
#include "view/http_server.h"

namespace troffer {

class YearAnswers {
 public:
  // bounds, file: of the scene shown, for notes() on a year that is of another scene.
  YearAnswers(std::shared_ptr<StoredHours> year, const Boxd& bounds, const std::string& file);

  // Returns why the year may belong to another scene; empty: no such sign.
  const std::vector<std::string>& notes() const { return notes_; }
  const std::vector<MeasuringPoint>& points() const { return hours_->year().points; }

  // "year" describes sensors, hours and window groups, as JSON. "year/points" returns six doubles
  // per sensor: position and normal. "year/glare" returns, eye by eye, the DGP of all hours and
  // then the illuminance at the eye. "year/hour" returns all sensors in one hour, "year/sensor" all
  // hours of one sensor, followed by their standard errors if these are known. Throws UsageError
  // for other requests, and InputError if files have changed.
  HttpResponse answer(const HttpRequest& request);

 private:
  HttpResponse description() const;
  HttpResponse positions() const;
  HttpResponse glare() const;

  std::shared_ptr<StoredHours> hours_;
  std::vector<std::string> notes_;
};

// Returns per point whether a camera sees it: 1, or 0 if a surface other than a pane of clear glass
// lies before it, or if it is behind the camera. Points outside of the picture count as seen.
std::vector<uint8_t> points_in_sight(const PreparedScene& scene, const Camera& camera,
                                     const std::vector<MeasuringPoint>& points);

}  // namespace troffer
