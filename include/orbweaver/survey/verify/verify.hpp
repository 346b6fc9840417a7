#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/survey/run/survey.hpp"

namespace orbweaver::survey {

/// A claim of an archive that does not hold.
struct Objection {
  std::string table;  ///< "orbits", ...; empty: the root attributes
  std::int64_t row = -1;
  std::string column;  ///< empty: the row as a whole
  std::string text;    ///< what is claimed, and what was found

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, table, row, column, text);
  }
};

/// How near the numbers of one column came to what is allowed.
struct Margin {
  std::string column;  ///< "orbits/energy"
  double worst = 0.0;  ///< the largest deviation in parts of what is allowed there
  std::int64_t row = -1;
  std::int64_t compared = 0;  ///< rows

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, column, worst, row, compared);
  }
};

/// What became of verifying an archive; on rank 0.
struct Verification {
  bool has_checksums = false;
  /// False where checksums do not hold: numbers that were changed are not judged.
  bool is_computed = false;
  std::int64_t families = 0;
  std::int64_t orbits = 0;
  std::int64_t crossings = 0;
  std::int64_t sections = 0;
  std::int64_t loci = 0;              ///< points of them
  std::int64_t equilibria = 0;        ///< and points of their curves
  std::int64_t uninformative = 0;     ///< orbits of which the certificate says nothing: too unstable to be integrated
  std::vector<Objection> objections;  ///< by table, then row
  std::vector<Margin> margins;        ///< one a column, by name
  double seconds = 0.0;
  int ranks = 1;

  [[nodiscard]] bool holds() const { return objections.empty(); }
};

/// Computes everything again from the stored modes alone and compares it with what the archive says
/// (docs/accuracy.md); first all checksums. Collective over `comm`: rows are tasks of the queue, the result does not
/// depend on the number of ranks. Throws InputError for what is no archive, and for one whose system is not known here.
[[nodiscard]] Verification verify(const core::Communicator& comm, const std::filesystem::path& atlas,
                                  Display display = Display::none);

}  // namespace orbweaver::survey
