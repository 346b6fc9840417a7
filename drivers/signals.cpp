#include "signals.hpp"

#include <csignal>

#include "orbweaver/queue/stop.hpp"

namespace orbweaver::drivers {

namespace {

constexpr int stop_signals[]{SIGTERM, SIGUSR1, SIGINT};

sigset_t stopping_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : stop_signals) sigaddset(&signals, signal);
  return signals;
}

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

void hold_signals() {
  const sigset_t signals = stopping_signals();
  sigprocmask(SIG_BLOCK, &signals, nullptr);
}

void release_signals() {
  const sigset_t signals = stopping_signals();
  sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

void stop_on_signals() {
  for (const int signal : stop_signals) {
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
  release_signals();
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
