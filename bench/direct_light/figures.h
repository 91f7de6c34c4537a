// Errors of answers with respect to the reference.
#pragma once

#include <string>

#include "methods.h"
#include "pairs.h"

namespace troffer::bench {

// Errors over counted pairs, in shares of the unoccluded light unless stated otherwise.
struct Figures {
  double rms = 0;        // RMSE of the visible share
  double mean = 0;       // signed
  double mean_size = 0;  // mean absolute error
  double worst = 0;
  double predicted = 0;  // root of the mean variance that the method estimated
  // RMSE of the direct irradiance of a hit, relative to the mean unoccluded irradiance
  double rms_light = 0;
};

Figures figures_of(const Pairs& pairs, const Answers& answers);

// Errors of certified answers of one kind, over counted pairs.
struct KindFigures {
  size_t pairs = 0;
  double rms = 0, predicted = 0;
};
KindFigures figures_of_kind(const Pairs& pairs, const Answers& answers, ShadowAnswer kind);

// Returns the largest relative error of the light, over counted pairs for which no reference ray
// was hidden.
double worst_where_open(const Pairs& pairs, const Answers& answers);

// Returns the number of counted pairs that were certified lit (dark) although a reference ray was
// hidden (open).
size_t contradictions(const Pairs& pairs, const Answers& answers);

}  // namespace troffer::bench
