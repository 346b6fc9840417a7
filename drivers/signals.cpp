#include "signals.hpp"

#include <csignal>

#include "orbweaver/queue/stop.hpp"

namespace orbweaver::drivers {

namespace {

volatile std::sig_atomic_t last_signal = 0;
volatile std::sig_atomic_t interrupted = 0;

extern "C" void ask_to_stop(int signal) {
  if (signal == SIGINT && interrupted != 0) {
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
  if (signal == SIGINT) interrupted = 1;
  last_signal = signal;
  queue::request_stop();
}

}  // namespace

void stop_on_signals() {
  for (const int signal : {SIGTERM, SIGUSR1, SIGINT}) {
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
}

std::string stop_signal() {
  switch (last_signal) {
    case SIGTERM: return "SIGTERM";
    case SIGUSR1: return "SIGUSR1";
    case SIGINT: return "SIGINT";
    default: return "";
  }
}

}  // namespace orbweaver::drivers
