#pragma once

#include <cstddef>
#include <ostream>
#include <string_view>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// How finely the page draws its orbits, as a part of each coordinate's range on the orbit: half a pixel of a picture
/// 1000 pixels high.
inline constexpr double page_tolerance = 5e-4;

/// Bytes that the thinned loops may take, compressed; beyond that only every n-th orbit of a family has its loop. With
/// it and base64 a page of 10,000 orbits stays below 25 MB.
inline constexpr std::size_t most_loop_bytes = 16'000'000;

/// What a page holds.
struct PageSummary {
  std::size_t families = 0;
  std::size_t orbits = 0;
  std::size_t bytes = 0;             ///< of the file
  std::size_t loop_bytes = 0;        ///< of it, the thinned loops
  std::size_t loops = 0;             ///< orbits that have theirs
  std::size_t harmonics_stored = 0;  ///< of these orbits, in the archive
  std::size_t harmonics_kept = 0;    ///< on the page, in the coordinate that needs most
  double deviation = 0.0;            ///< the largest of a coordinate, in parts of its range
};

/// Writes the interactive atlas (docs/page.md): `page_template`, with the archive's data in the place of its line
/// `<!-- atlas -->`. Columns keep all of their digits. Loops are thinned to `page_tolerance` and, where there are
/// many, to what `loop_bytes` hold. Everything from the archive is written as base64, so that no text in it is
/// markup. Throws MisuseError for a template without that line, InputError where the archive cannot be read.
PageSummary write_page(std::ostream& out, const archive::Archive& atlas, std::string_view page_template,
                       std::size_t loop_bytes = most_loop_bytes);

}  // namespace orbweaver::report
