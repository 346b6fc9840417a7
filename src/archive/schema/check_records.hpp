#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "orbweaver/archive/schema/records.hpp"

namespace orbweaver::archive {

/// Each throws MisuseError, saying which record and which member is wrong, what it holds and what was expected.
void check_header(const Header& header);
void check_orbits(const Header& header, const Records& records);
void check_sections(const Header& header, const Records& records);
/// Families and crossings as they are handed over for a finished archive.
void check_families(const Records& records);
void check_crossings(const Header& header, const Records& records);
void check_loci(const Header& header, const Records& records);
void check_equilibria(const Header& header, const Records& records);
/// `segments`: how many are listed to consolidate.
void check_voided(const Records& records, std::size_t segments);

/// What is wrong with the header's winding_coordinates; empty: nothing.
[[nodiscard]] std::string winding_problem(const Header& header);

/// Whether a loop of that cutoff in so many coordinates (1 or more) has `count` modes; false for any damaged numbers.
[[nodiscard]] bool is_mode_count(std::int64_t count, std::int64_t cutoff, std::int64_t dimension);

}  // namespace orbweaver::archive
