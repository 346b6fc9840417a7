#pragma once

#include <string>
#include <vector>

#include "numbering.hpp"
#include "orbweaver/archive/read/table.hpp"

namespace orbweaver::archive {

/// The tables that rank 0 hands over, in canonical order with indices instead of keys.
struct RootTables {
  Table families;
  Table crossings;
  Table loci;
  Table equilibria;
  Table model;
};

/// What `tables` says of the rows of the segments.
[[nodiscard]] Selection selection_of(const Records& tables);

/// `tables` must have been checked (check_records.hpp); `keys` are its sorted keys; `model`: its text, of rank 0.
[[nodiscard]] RootTables make_root_tables(const Header& header, const Records& tables,
                                          const std::vector<std::string>& keys, const std::string& model,
                                          const Numbering& numbering);

/// /findings, in the order given.
[[nodiscard]] Table make_findings(const std::vector<FindingRecord>& findings);

}  // namespace orbweaver::archive
