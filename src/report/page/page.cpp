#include "orbweaver/report/page/page.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/core/error.hpp"
#include "page/encoding.hpp"
#include "page/page_columns.hpp"
#include "page/page_index.hpp"
#include "page/thinned_loop.hpp"

namespace orbweaver::report {

namespace {

constexpr std::string_view place_of_data = "<!-- atlas -->";
/// Orbits that are compressed together: enough for similar neighbours to help, few enough to unpack one at once.
constexpr std::size_t orbits_a_block = 64;
/// Blocks begin at whole groups of base64, so that each is decoded alone.
constexpr std::size_t base64_group = 3;

struct Loops {
  std::vector<std::uint8_t> bytes;     ///< of all blocks, compressed
  std::vector<std::size_t> blocks;     ///< where each begins, and the end
  std::vector<std::int64_t> begins;    ///< of an orbit, in its block unpacked
  std::vector<double> amplitudes;
  std::vector<double> largest;         ///< orbits x dimension
  std::size_t harmonics_kept = 0;
};

Loops loops_of(const archive::Archive& atlas) {
  const std::vector<int> angles = angles_of(atlas.header());
  const std::size_t orbits = atlas.orbits().rows();
  Loops loops;
  loops.blocks.push_back(0);
  std::vector<std::uint8_t> block;
  for (std::size_t orbit = 0; orbit < orbits; ++orbit) {
    const ThinnedLoop loop = thinned(archive::loop_of(atlas, orbit, angles), page_tolerance);
    loops.begins.push_back(static_cast<std::int64_t>(block.size()));
    loops.amplitudes.push_back(loop.amplitude);
    loops.largest.insert(loops.largest.end(), loop.largest.begin(), loop.largest.end());
    loops.harmonics_kept += static_cast<std::size_t>(loop.harmonics);
    block.insert(block.end(), loop.bytes.begin(), loop.bytes.end());
    if ((orbit + 1) % orbits_a_block != 0 && orbit + 1 != orbits) continue;
    const std::vector<std::uint8_t> packed = deflated(block);
    loops.bytes.insert(loops.bytes.end(), packed.begin(), packed.end());
    loops.blocks.push_back(loops.bytes.size());
    loops.bytes.resize((loops.bytes.size() + base64_group - 1) / base64_group * base64_group);
    block.clear();
  }
  return loops;
}

/// [begin, end, begin, end, ...] in bytes: what pads a block is not part of it.
std::string block_places(const Loops& loops) {
  std::vector<std::size_t> places;
  for (std::size_t block = 0; block + 1 < loops.blocks.size(); ++block) {
    places.push_back((loops.blocks[block] + base64_group - 1) / base64_group * base64_group);
    places.push_back(loops.blocks[block + 1]);
  }
  return fmt::format("[{}]", fmt::join(places, ","));
}

std::string element(std::string_view id, std::span<const std::uint8_t> bytes) {
  return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(bytes));
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

PageSummary write_page(std::ostream& out, const archive::Archive& atlas, std::string_view page_template) {
  const std::size_t place = page_template.find(place_of_data);
  core::require(place != std::string_view::npos, "the page's template has no place for the data");
  const Loops loops = loops_of(atlas);
  PageColumns columns;
  add_orbit_columns(columns, atlas);
  columns.add_float64("amplitude", loops.amplitudes, 1);
  columns.add_float64("largest", loops.largest, atlas.header().state_names.size());
  columns.add_int32("loop_begin", loops.begins);

  PageSummary summary;
  summary.families = atlas.families().rows();
  summary.orbits = atlas.orbits().rows();
  summary.harmonics_kept = loops.harmonics_kept;
  for (const std::int64_t cutoff : atlas.orbits().integers("cutoff"))
    summary.harmonics_stored += static_cast<std::size_t>(cutoff);

  const std::string index = fmt::format(
      R"({{"page":1,"orbits":{},"orbitsABlock":{},"tolerance":{},"harmonicsKept":{},"harmonicsStored":{},"blocks":{},"columns":{},{}}})",
      summary.orbits, orbits_a_block, json_number(page_tolerance), summary.harmonics_kept, summary.harmonics_stored,
      block_places(loops), columns.json(), index_members(atlas));

  const std::string loop_element = element("atlas-loops", loops.bytes);
  const std::string rest = element("atlas-index", deflated(bytes_of(index))) +
                           element("atlas-columns", deflated(columns.bytes()));
  out << page_template.substr(0, place) << rest << loop_element
      << page_template.substr(place + place_of_data.size());
  summary.loop_bytes = loop_element.size();
  summary.bytes = page_template.size() - place_of_data.size() + rest.size() + loop_element.size();
  return summary;
}

}  // namespace orbweaver::report
