#include "app/signals.h"

#include <csignal>

#include <unistd.h>

namespace troffer {

namespace {

// A signal handler can only reach a global.
StopFlag stop_requested = false;
static_assert(StopFlag::is_always_lock_free);

extern "C" void on_stop_signal(int) {
  if (stop_requested.exchange(true)) _exit(130);
}

}  // namespace

const StopFlag& install_stop_handlers() {
  struct sigaction action = {};
  action.sa_handler = on_stop_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return stop_requested;
}

}  // namespace troffer
