#include "orbweaver/core/mpi/collective.hpp"

#include <algorithm>
#include <climits>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"

namespace orbweaver::core {

namespace {

/// Another rank's MisuseError, whose text names its place already.
class PassedOnMisuse : public MisuseError {
 public:
  explicit PassedOnMisuse(std::string text) : MisuseError(""), _text(std::move(text)) {}
  [[nodiscard]] const char* what() const noexcept override { return _text.c_str(); }

 private:
  std::string _text;
};

void broadcast_text(MPI_Comm comm, std::string& text, int root) {
  auto length = static_cast<std::uint64_t>(text.size());
  detail::broadcast_bytes(comm, &length, sizeof length, root);
  text.resize(length);
  detail::broadcast_bytes(comm, text.data(), length, root);
}

}  // namespace

Failure attempt(const std::function<void()>& work) {
  const auto failure = [](FailureKind kind, const char* text) { return Failure{kind, text, std::current_exception()}; };
  try {
    work();
    return {};
  } catch (const NewerVersionError& error) {
    return failure(FailureKind::newer_version, error.what());
  } catch (const InputError& error) {
    return failure(FailureKind::input, error.what());
  } catch (const EnvironmentError& error) {
    return failure(FailureKind::environment, error.what());
  } catch (const NotFiniteError& error) {
    return failure(FailureKind::not_finite, error.what());
  } catch (const NumericalError& error) {
    return failure(FailureKind::numerical, error.what());
  } catch (const MisuseError& error) {
    return failure(FailureKind::misuse, error.what());
  } catch (const std::exception& error) {
    return failure(FailureKind::other, error.what());
  } catch (...) {
    return failure(FailureKind::other, "something that is not an exception was thrown");
  }
}

void raise(const Failure& failure) {
  if (failure.error) std::rethrow_exception(failure.error);
  switch (failure.kind) {
    case FailureKind::newer_version: throw NewerVersionError(failure.text);
    case FailureKind::input: throw InputError(failure.text);
    case FailureKind::not_finite: throw NotFiniteError(failure.text);
    case FailureKind::numerical: throw NumericalError(failure.text);
    case FailureKind::misuse: throw PassedOnMisuse(failure.text);
    case FailureKind::none: throw MisuseError("nothing failed that could be raised");
    case FailureKind::environment:
    case FailureKind::other: break;
  }
  throw EnvironmentError(failure.text);
}

std::optional<SharedFailure> share(MPI_Comm comm, const Failure& mine) {
  const int nobody = size_of(comm);
  const int me = rank_of(comm);
  const int candidate = mine ? me : nobody;
  int speaker = nobody;
  check_mpi(MPI_Allreduce(&candidate, &speaker, 1, MPI_INT, MPI_MIN, comm), "MPI_Allreduce");
  if (speaker == nobody) return std::nullopt;
  SharedFailure shared{speaker, me == speaker ? mine : Failure{}};
  detail::broadcast_bytes(comm, &shared.failure.kind, sizeof shared.failure.kind, speaker);
  broadcast_text(comm, shared.failure.text, speaker);
  return shared;
}

void collectively(MPI_Comm comm, const std::function<void()>& work) {
  if (const std::optional<SharedFailure> shared = share(comm, attempt(work))) raise(shared->failure);
}

void on_root(MPI_Comm comm, const std::function<void()>& work) {
  collectively(comm, [&] {
    if (rank_of(comm) == 0) work();
  });
}

int rank_of(MPI_Comm comm) {
  int rank = 0;
  check_mpi(MPI_Comm_rank(comm, &rank), "MPI_Comm_rank");
  return rank;
}

int size_of(MPI_Comm comm) {
  int size = 1;
  check_mpi(MPI_Comm_size(comm, &size), "MPI_Comm_size");
  return size;
}

std::string agreed(MPI_Comm comm, std::string text) {
  broadcast_text(comm, text, 0);
  return text;
}

std::vector<std::string> agreed(MPI_Comm comm, std::vector<std::string> texts) {
  texts.resize(agreed(comm, texts.size()));
  std::vector<std::uint64_t> lengths;
  std::string joined;
  for (const std::string& text : texts) {
    lengths.push_back(text.size());
    joined += text;
  }
  detail::broadcast_bytes(comm, lengths.data(), lengths.size() * sizeof(std::uint64_t), 0);
  broadcast_text(comm, joined, 0);
  std::size_t at = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    texts[i] = joined.substr(at, lengths[i]);
    at += lengths[i];
  }
  return texts;
}

Share share_of(MPI_Comm comm, std::uint64_t mine) {
  Share share;
  check_mpi(MPI_Exscan(&mine, &share.first, 1, MPI_UINT64_T, MPI_SUM, comm), "MPI_Exscan");
  if (rank_of(comm) == 0) share.first = 0;
  check_mpi(MPI_Allreduce(&mine, &share.total, 1, MPI_UINT64_T, MPI_SUM, comm), "MPI_Allreduce");
  return share;
}

std::uint64_t greatest(MPI_Comm comm, std::uint64_t mine) {
  std::uint64_t all = 0;
  check_mpi(MPI_Allreduce(&mine, &all, 1, MPI_UINT64_T, MPI_MAX, comm), "MPI_Allreduce");
  return all;
}

void detail::broadcast_bytes(MPI_Comm comm, void* bytes, std::size_t count, int root) {
  require(count <= INT_MAX, "what is broadcast is longer than MPI can send");
  check_mpi(MPI_Bcast(bytes, static_cast<int>(count), MPI_BYTE, root, comm), "MPI_Bcast");
}

void detail::gather_bytes(MPI_Comm comm, const void* mine, std::size_t count, std::size_t row_bytes,
                          const std::function<void*(std::size_t)>& allocate) {
  const int my_count = static_cast<int>(count);
  std::vector<int> counts(static_cast<std::size_t>(size_of(comm)));
  check_mpi(MPI_Allgather(&my_count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm), "MPI_Allgather");
  std::vector<int> starts(counts.size());
  std::uint64_t total = 0;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    starts[r] = static_cast<int>(total);
    total += static_cast<std::uint64_t>(counts[r]);
  }
  require(total <= INT_MAX, "more than 2^31 rows are gathered");
  void* all = nullptr;
  collectively(comm, [&] { all = allocate(total); });  // a rank without room for them leaves nobody waiting
  MPI_Datatype row = MPI_DATATYPE_NULL;
  check_mpi(MPI_Type_contiguous(static_cast<int>(row_bytes), MPI_BYTE, &row), "MPI_Type_contiguous");
  check_mpi(MPI_Type_commit(&row), "MPI_Type_commit");
  const int code = MPI_Allgatherv(mine, my_count, row, all, counts.data(), starts.data(), row, comm);
  MPI_Type_free(&row);
  check_mpi(code, "MPI_Allgatherv");
}

}  // namespace orbweaver::core
