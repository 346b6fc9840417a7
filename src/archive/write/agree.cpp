#include "agree.hpp"

#include <climits>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"

namespace orbweaver::archive {

namespace {

enum class Kind : int { none, input, environment, numerical, misuse };

struct Problem {
  Kind kind = Kind::none;
  std::string text;
};

Problem run(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const core::InputError& error) {
    return {Kind::input, error.what()};
  } catch (const core::NumericalError& error) {
    return {Kind::numerical, error.what()};
  } catch (const core::MisuseError& error) {
    return {Kind::misuse, error.what()};
  } catch (const std::exception& error) {
    return {Kind::environment, error.what()};
  }
}

[[noreturn]] void raise(const Problem& problem) {
  switch (problem.kind) {
    case Kind::input: throw core::InputError(problem.text);
    case Kind::numerical: throw core::NumericalError(problem.text);
    case Kind::misuse: throw core::MisuseError(problem.text);
    default: throw core::EnvironmentError(problem.text);
  }
}

void broadcast_text(MPI_Comm comm, std::string& text, int root) {
  auto length = static_cast<std::uint64_t>(text.size());
  core::check_mpi(MPI_Bcast(&length, 1, MPI_UINT64_T, root, comm), "MPI_Bcast");
  text.resize(length);
  core::require(length <= INT_MAX, "a broadcast text is longer than MPI can send");
  core::check_mpi(MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, root, comm), "MPI_Bcast");
}

}  // namespace

int rank_of(MPI_Comm comm) {
  int rank = 0;
  core::check_mpi(MPI_Comm_rank(comm, &rank), "MPI_Comm_rank");
  return rank;
}

int size_of(MPI_Comm comm) {
  int size = 1;
  core::check_mpi(MPI_Comm_size(comm, &size), "MPI_Comm_size");
  return size;
}

void collectively(MPI_Comm comm, const std::function<void()>& work) {
  Problem problem = run(work);
  const int nobody = size_of(comm);
  const int mine = problem.kind == Kind::none ? nobody : rank_of(comm);
  int speaker = nobody;
  core::check_mpi(MPI_Allreduce(&mine, &speaker, 1, MPI_INT, MPI_MIN, comm), "MPI_Allreduce");
  if (speaker == nobody) return;
  int kind = static_cast<int>(problem.kind);
  core::check_mpi(MPI_Bcast(&kind, 1, MPI_INT, speaker, comm), "MPI_Bcast");
  problem.kind = static_cast<Kind>(kind);
  broadcast_text(comm, problem.text, speaker);
  raise(problem);
}

Share share_of(MPI_Comm comm, std::uint64_t mine) {
  Share share;
  core::check_mpi(MPI_Exscan(&mine, &share.first, 1, MPI_UINT64_T, MPI_SUM, comm), "MPI_Exscan");
  if (rank_of(comm) == 0) share.first = 0;
  core::check_mpi(MPI_Allreduce(&mine, &share.total, 1, MPI_UINT64_T, MPI_SUM, comm), "MPI_Allreduce");
  return share;
}

std::uint64_t greatest(MPI_Comm comm, std::uint64_t mine) {
  std::uint64_t all = 0;
  core::check_mpi(MPI_Allreduce(&mine, &all, 1, MPI_UINT64_T, MPI_MAX, comm), "MPI_Allreduce");
  return all;
}

void broadcast(MPI_Comm comm, std::vector<std::string>& texts) {
  auto count = static_cast<std::uint64_t>(texts.size());
  core::check_mpi(MPI_Bcast(&count, 1, MPI_UINT64_T, 0, comm), "MPI_Bcast");
  texts.resize(count);
  std::vector<std::uint64_t> lengths;
  std::string joined;
  for (const std::string& text : texts) {
    lengths.push_back(text.size());
    joined += text;
  }
  core::check_mpi(MPI_Bcast(lengths.data(), static_cast<int>(count), MPI_UINT64_T, 0, comm), "MPI_Bcast");
  broadcast_text(comm, joined, 0);
  std::size_t at = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    texts[i] = joined.substr(at, lengths[i]);
    at += lengths[i];
  }
}

void detail::gather_bytes(MPI_Comm comm, const void* mine, std::size_t count, std::size_t row_bytes,
                          const std::function<void*(std::size_t)>& allocate) {
  const int ranks = size_of(comm);
  const int my_count = static_cast<int>(count);
  std::vector<int> counts(static_cast<std::size_t>(ranks));
  core::check_mpi(MPI_Allgather(&my_count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm), "MPI_Allgather");
  std::vector<int> starts(counts.size());
  std::uint64_t total = 0;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    starts[r] = static_cast<int>(total);
    total += static_cast<std::uint64_t>(counts[r]);
  }
  core::require(total <= INT_MAX, "an archive of more than 2^31 rows");
  void* all = allocate(total);
  MPI_Datatype row = MPI_DATATYPE_NULL;
  core::check_mpi(MPI_Type_contiguous(static_cast<int>(row_bytes), MPI_BYTE, &row), "MPI_Type_contiguous");
  core::check_mpi(MPI_Type_commit(&row), "MPI_Type_commit");
  const int code = MPI_Allgatherv(mine, my_count, row, all, counts.data(), starts.data(), row, comm);
  MPI_Type_free(&row);
  core::check_mpi(code, "MPI_Allgatherv");
}

}  // namespace orbweaver::archive
