#pragma once

#include <cstddef>

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

}  // namespace orbweaver::archive
