// How long work tells how far it is.
#pragma once

#include <functional>

namespace troffer {

// Called from one thread at a time, with the fraction done in [0,1].
using ProgressCallback = std::function<void(double fraction)>;

}  // namespace troffer
