#include "app/signals.h"

#include <csignal>

#include <unistd.h>

#include "image/temporary_files.h"

namespace troffer {

namespace {

// A signal handler can only reach a global.
StopFlag stop_requested = false;
static_assert(StopFlag::is_always_lock_free);

// `text` is a literal: in a handler only write() is safe.
template <size_t size>
[[noreturn]] void end_at_once(const char (&text)[size]) {
  remove_temporary_files();
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, size - 1);
  _exit(130);
}

extern "C" void on_stop_signal(int) {
  if (stop_requested.exchange(true)) end_at_once("interrupted again: ended at once\n");
}
extern "C" void on_early_signal(int) {
  end_at_once("interrupted: nothing was written\n");
}

void handle_stop_signals(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void exit_on_stop_signals() {
  handle_stop_signals(on_early_signal);
  // Reaching the limit of file sizes becomes a write error.
  signal(SIGXFSZ, SIG_IGN);
}

const StopFlag& install_stop_handlers() {
  handle_stop_signals(on_stop_signal);
  return stop_requested;
}

void stop_on_user_signal() {
  struct sigaction action = {};
  action.sa_handler = on_stop_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGUSR1, &action, nullptr);
}

}  // namespace troffer
