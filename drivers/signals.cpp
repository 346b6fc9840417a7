#include "signals.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>

#include <unistd.h>

#include "orbweaver/core/posix_file.hpp"
#include "orbweaver/queue/stop.hpp"

namespace orbweaver::drivers {

namespace {

struct Named {
  int number;
  const char* name;
};
constexpr Named stop_signals[]{{SIGTERM, "SIGTERM"}, {SIGUSR1, "SIGUSR1"}, {SIGINT, "SIGINT"}, {SIGHUP, "SIGHUP"}};

/// Under nohup a hang-up is to pass unheard.
bool is_ignored(int signal) {
  struct sigaction now {};
  return signal == SIGHUP && sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Names a file into which `launch` writes what signal it passes on, which mpirun hands to the ranks as SIGUSR1.
std::string file_of_passed_on() {
  const char* mark = std::getenv(mark_variable);
  return mark == nullptr ? "" : std::string(mark) + ".signal";
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

sigset_t stopping_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const Named& signal : stop_signals)
    if (!is_ignored(signal.number)) sigaddset(&signals, signal.number);
  return signals;
}

void hold_signals() {
  const sigset_t signals = stopping_signals();
  sigprocmask(SIG_BLOCK, &signals, nullptr);
}

void release_signals() {
  const sigset_t signals = stopping_signals();
  sigprocmask(SIG_UNBLOCK, &signals, nullptr);
}

void stop_on_signals() {
  for (const Named& signal : stop_signals) {
    if (is_ignored(signal.number)) continue;
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESTART;
    sigaction(signal.number, &action, nullptr);
  }
  release_signals();
}

void tell_passed_on(int signal) {
  for (const Named& one : stop_signals)
    if (one.number == signal) core::write_file(file_of_passed_on(), {one.name});
}

void forget_passed_on() {
  if (const std::string file = file_of_passed_on(); !file.empty()) unlink(file.c_str());
}

std::string stop_signal() {
  std::string passed_on;
  if (last_signal == SIGUSR1 && std::getenv(mark_variable) != nullptr) std::ifstream(file_of_passed_on()) >> passed_on;
  for (const Named& signal : stop_signals) {
    if (!passed_on.empty() && passed_on == signal.name) return signal.name;
    if (passed_on.empty() && last_signal == signal.number) return signal.name;
  }
  return "";
}

}  // namespace orbweaver::drivers
