// How far answers are from the reference.
#pragma once

#include <string>

#include "methods.h"
#include "pairs.h"

namespace troffer::bench {

// Over counted pairs; shares of the unoccluded light unless said otherwise.
struct Figures {
  double rms = 0;        // of the visible share
  double mean = 0;       // signed
  double mean_size = 0;  // of the error's absolute value
  double worst = 0;
  double predicted = 0;  // root of the mean variance that the method told
  // RMSE of the direct irradiance of a hit, over the mean of what would arrive unoccluded
  double rms_light = 0;
};

Figures figures_of(const Pairs& pairs, const Answers& answers);

// Of certified answers, over counted pairs of one kind.
struct KindFigures {
  size_t pairs = 0;
  double rms = 0, predicted = 0;
};
KindFigures figures_of_kind(const Pairs& pairs, const Answers& answers, ShadowAnswer kind);

// Largest relative difference of the light from the exact one, over counted pairs of which no ray
// of the reference was hidden.
double worst_where_open(const Pairs& pairs, const Answers& answers);

// Counted pairs that were certified lit (dark) though a ray of the reference was hidden (open).
size_t contradictions(const Pairs& pairs, const Answers& answers);

}  // namespace troffer::bench
