// Callback by which long work reports its progress.
#pragma once

#include <functional>

namespace troffer {

// Receives the fraction done, in [0,1]. Called from one thread at a time.
using ProgressCallback = std::function<void(double fraction)>;

}  // namespace troffer
