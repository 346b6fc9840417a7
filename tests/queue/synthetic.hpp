#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/run.hpp"

namespace synthetic {

namespace queue = orbweaver::queue;

/// 64 bits that depend on a key and a number alone.
inline std::uint64_t hash(std::string_view key, std::uint64_t salt) {
  std::vector<std::uint32_t> seed(key.begin(), key.end());
  seed.push_back(static_cast<std::uint32_t>(salt));
  seed.push_back(static_cast<std::uint32_t>(salt >> 32));
  std::seed_seq sequence(seed.begin(), seed.end());
  return std::mt19937_64(sequence)();
}

inline void sleep_us(std::uint64_t microseconds) {
  std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
}

inline queue::Task task(std::string key, int priority = 0, std::string payload = {}) {
  return {std::move(key), priority, "synthetic", std::move(payload)};
}

inline std::vector<queue::Task> tasks(int count) {
  std::vector<queue::Task> made;
  for (int i = 0; i < count; ++i) made.push_back(task(fmt::format("t{}", i)));
  return made;
}

/// Rank 0 only waits, whatever the number of ranks.
inline queue::Options waiting_root() {
  queue::Options options;
  options.root_works_up_to = 1;
  return options;
}

/// Ranks that do tasks.
inline int computing(const orbweaver::core::Communicator& comm, const queue::Options& options = {}) {
  return comm.size() <= options.root_works_up_to ? comm.size() : comm.size() - 1;
}

/// An executor, observer or flusher out of a function.
class Work final : public queue::Executor {
 public:
  using Function = std::function<queue::TaskOutcome(const queue::Task&, queue::TaskContext&)>;
  explicit Work(Function function) : _function(std::move(function)) {}
  queue::TaskOutcome execute(const queue::Task& t, queue::TaskContext& context) override {
    return _function(t, context);
  }

 private:
  Function _function;
};

class Flush final : public queue::Flusher {
 public:
  explicit Flush(std::function<void(int)> function = [](int) {}) : _function(std::move(function)) {}
  void flush(int number) override {
    ++calls;
    _function(number);
  }
  int calls = 0;

 private:
  std::function<void(int)> _function;
};

inline std::int64_t sum(const orbweaver::core::Communicator& comm, std::int64_t mine) {
  std::int64_t all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT64_T, MPI_SUM, comm.get());
  return all;
}

/// Whether `text` is the same on all ranks. Collective.
inline bool same_everywhere(const orbweaver::core::Communicator& comm, const std::string& text) {
  std::string root = text;
  auto length = static_cast<int>(root.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, comm.get());
  root.resize(static_cast<std::size_t>(length));
  MPI_Bcast(root.data(), length, MPI_CHAR, 0, comm.get());
  return sum(comm, root == text ? 0 : 1) == 0;
}

/// The text of the EnvironmentError that a run ends with here; "" and a failure when it ends without one.
inline std::string error_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const orbweaver::core::EnvironmentError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "expected an EnvironmentError, got: " << error.what();
    return "";
  }
  ADD_FAILURE() << "expected an EnvironmentError, and the run ended well";
  return "";
}

}  // namespace synthetic
