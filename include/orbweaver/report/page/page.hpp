#pragma once

#include <cstddef>
#include <ostream>
#include <string_view>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// How finely the page draws its orbits, as a part of each coordinate's range on the orbit: half a pixel of a picture
/// 1000 pixels high.
inline constexpr double page_tolerance = 5e-4;

/// What a page holds.
struct PageSummary {
  std::size_t families = 0;
  std::size_t orbits = 0;
  std::size_t bytes = 0;             ///< of the file
  std::size_t loop_bytes = 0;        ///< of it, the thinned loops
  std::size_t harmonics_stored = 0;  ///< of all orbits in the archive
  std::size_t harmonics_kept = 0;    ///< of them, those that a coordinate has on the page, the most of its coordinates
};

/// Writes the interactive atlas (docs/page.md): `page_template`, with the archive's data in the place of its line
/// `<!-- atlas -->`. Columns keep all of their digits; loops are thinned: what is left out moves no coordinate by more
/// than `page_tolerance` of its range. Everything from the archive is written as base64, so that no text in it is
/// markup. Throws MisuseError for a template without that line, InputError where the archive cannot be read.
PageSummary write_page(std::ostream& out, const archive::Archive& atlas, std::string_view page_template);

}  // namespace orbweaver::report
