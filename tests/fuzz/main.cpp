#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "archive/sample.hpp"
#include "failure.hpp"
#include "fuzz/kinds.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/core/text.hpp"

// fuzz KIND COUNT          reads COUNT inputs
// fuzz KIND --only NUMBER  reads one of them again
// fuzz KIND --write COUNT  writes COUNT inputs as files input-NUMBER into the working folder, and reads none
//
// An input fails that crashes, takes longer or more memory than the bounds below, ends otherwise than with success or
// the status of wrong input, or is refused with a text that cannot be shown as it is.

namespace {

using namespace orbweaver;
using Clock = std::chrono::steady_clock;

constexpr unsigned longest_seconds = 5;  // of one input: issue 16
constexpr std::size_t most_memory = 500UL << 20;
/// Longer than any message: what came is shortened where it is echoed.
constexpr std::size_t longest_text = 8192;
constexpr int failures_shown = 10;

volatile std::uint64_t current = 0;  // for what a signal says
char repeat_with[200];

extern "C" void tell_and_end(int signal) {
  char text[400];
  const int length =
      std::snprintf(text, sizeof text, "fuzz: signal %d (%s) at input %llu; again with: %s %llu\n", signal,
                    signal == SIGALRM ? "out of time" : "a crash", static_cast<unsigned long long>(current),
                    repeat_with, static_cast<unsigned long long>(current));
  static_cast<void>(!write(STDERR_FILENO, text, static_cast<std::size_t>(length)));
  _exit(1);
}

void bound_the_process() {
  for (const int signal : {SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
#ifdef __SANITIZE_ADDRESS__
    if (signal != SIGALRM) continue;  // it says more
#endif
    std::signal(signal, tell_and_end);
  }
#ifndef __SANITIZE_ADDRESS__  // whose shadow alone takes more
  const rlimit limit{most_memory, most_memory};
  setrlimit(RLIMIT_DATA, &limit);
#endif
}

fuzz::Kind kind_of(const std::string& name) {
  const auto folder = [&] { return test::fresh_folder("fuzz_" + name); };
  const std::map<std::string, std::function<fuzz::Kind()>> kinds{
      {"scenes", fuzz::scenes},
      {"grown_scenes", fuzz::grown_scenes},
      {"overrides", fuzz::overrides},
      {"models", fuzz::models},
      {"messages", fuzz::messages},
      {"loops", fuzz::loops},
      {"descriptions", fuzz::descriptions},
      {"proofs", [&] { return fuzz::proofs(folder()); }},
      {"start_archives", [&] { return fuzz::start_archives(folder()); }},
      {"archives", [&] { return fuzz::archives(folder()); }},
      {"segments", [&] { return fuzz::segments(folder()); }},
      {"checkpoints", [&] { return fuzz::checkpoints(folder()); }},
      {"journals", [&] { return fuzz::journals(folder()); }},
      {"payloads", [&] { return fuzz::payloads(folder()); }},
  };
  const auto found = kinds.find(name);
  if (found != kinds.end()) return found->second();
  std::vector<std::string> names;
  for (const auto& [known, make] : kinds) names.push_back(known);
  throw core::InputError(fmt::format("expected a kind among {}, got `{}`", fmt::join(names, ", "), name));
}

std::string input_of(const fuzz::Kind& kind, std::uint64_t number) {
  fuzz::Mutator mutator(number);
  return kind.make(mutator);
}

enum class End { accepted, refused };

/// Throws std::string: what is wrong.
End end_of(const fuzz::Kind& kind, const std::string& input) {
  try {
    kind.read(input);
    return End::accepted;
  } catch (const fuzz::WrongReading& wrong) {
    throw wrong.what;
  } catch (...) {
    const drivers::Failure failure = drivers::describe_failure(std::current_exception());
    if (failure.status != static_cast<int>(core::ExitStatus::wrong_input))
      throw fmt::format("status {}: {}", failure.status, failure.message);
    if (core::printable_lines(failure.message) != failure.message)
      throw "the message has raw bytes: " + failure.message;
    if (failure.message.size() > longest_text) throw fmt::format("a message of {} bytes", failure.message.size());
    return End::refused;
  }
}

int read_inputs(const std::string& name, const fuzz::Kind& kind, std::uint64_t first, std::uint64_t count) {
  std::uint64_t accepted = 0, refused = 0;
  int failed = 0;
  double longest = 0.0;
  const auto began = Clock::now();
  for (std::uint64_t n = first; n < first + count; ++n) {
    current = n;
    const std::string input = input_of(kind, n);
    const auto start = Clock::now();
    alarm(longest_seconds);
    try {
      ++(end_of(kind, input) == End::accepted ? accepted : refused);
    } catch (const std::string& wrong) {
      if (++failed <= failures_shown)
        fmt::print(stderr, "fuzz: input {}: {}\n  again with: {} {}\n  the input: {}\n", n, core::printable(wrong),
                   repeat_with, n, core::shortened(core::printable(input), 2000));
    }
    alarm(0);
    longest = std::max(longest, std::chrono::duration<double>(Clock::now() - start).count());
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto peak = static_cast<std::size_t>(usage.ru_maxrss) << 10;
  fmt::print(
      "{}: {} inputs in {:.1f} s, {} accepted, {} refused, {} failed, the longest took {:.3f} s, peak memory {} MB\n",
      name, count, std::chrono::duration<double>(Clock::now() - began).count(), accepted, refused, failed, longest,
      peak >> 20);
#ifndef __SANITIZE_ADDRESS__
  if (peak > most_memory) ++failed;
#endif
  const bool one_sided = count > 1 && (accepted == 0 || refused == 0);
  if (one_sided) fmt::print(stderr, "fuzz: none was accepted, or none refused: the inputs test nothing\n");
  return failed > 0 || one_sided ? 1 : 0;
}

int run(const std::vector<std::string>& words) {
  if (words.size() < 2) throw core::InputError("expected KIND and COUNT, KIND --only NUMBER or KIND --write COUNT");
  const fuzz::Kind kind = kind_of(words[0]);
  const std::uint64_t number = std::strtoull(words.back().c_str(), nullptr, 10);
  if (words[1] == "--write") {
    for (std::uint64_t n = 0; n < number; ++n) fuzz::write_bytes(fmt::format("input-{}", n), input_of(kind, n));
    return 0;
  }
  bound_the_process();
  const bool only = words[1] == "--only";
  return read_inputs(words[0], kind, only ? number : 0, only ? 1 : number);
}

}  // namespace

std::string orbweaver::fuzz::bytes_of(const std::filesystem::path& file) {
  return (std::ostringstream() << std::ifstream(file, std::ios::binary).rdbuf()).str();
}

void orbweaver::fuzz::write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::remove(file);  // ext4 writes a file that replaces another out to the disk at once
  std::ofstream(file, std::ios::binary) << bytes;
}

int main(int argc, char** argv) {
  const core::Session session;
  std::snprintf(repeat_with, sizeof repeat_with, "%s %s --only", argv[0], argc > 1 ? argv[1] : "KIND");
  try {
    return run({argv + 1, argv + argc});
  } catch (...) {
    return drivers::report_failure(std::current_exception());
  }
}
