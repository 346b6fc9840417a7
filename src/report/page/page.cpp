#include "orbweaver/report/page/page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/core/error.hpp"
#include "page/encoding.hpp"
#include "page/page_columns.hpp"
#include "page/page_index.hpp"
#include "page/thinned_loop.hpp"
#include "stored_system.hpp"

namespace orbweaver::report {

namespace {

constexpr std::string_view place_of_data = "<!-- atlas -->";
/// Orbits that are compressed together: enough for similar neighbours to help, few enough to unpack one at once.
constexpr std::size_t orbits_a_block = 64;
/// Bytes in four letters.
constexpr std::size_t base64_group = 3;

/// Blocks from which the size of all is estimated.
constexpr std::size_t blocks_tried = 8;

struct Loops {
  std::vector<std::uint8_t> bytes;   ///< of all blocks, compressed
  std::vector<std::size_t> blocks;   ///< begin, end, begin, end, ... in `bytes`
  std::vector<std::int64_t> begins;  ///< of an orbit, in its block unpacked; -1: it has none
  std::vector<std::int64_t> block_of;
  std::vector<double> amplitudes;
  std::vector<double> largest;  ///< orbits x dimension
  std::size_t count = 0;
  std::size_t harmonics_stored = 0;
  std::size_t harmonics_kept = 0;
  double deviation = 0.0;
};

/// Compressed in blocks, each beginning at a whole group of base64.
class Blocks {
 public:
  explicit Blocks(Loops& loops) : _loops(loops) {}

  void add(std::size_t orbit, const ThinnedLoop& loop) {
    _loops.begins[orbit] = static_cast<std::int64_t>(_open.size());
    _loops.block_of[orbit] = static_cast<std::int64_t>(_loops.blocks.size() / 2);
    _open.insert(_open.end(), loop.bytes.begin(), loop.bytes.end());
    if (++_orbits == orbits_a_block) close();
  }
  void close() {
    if (_orbits == 0) return;
    const std::vector<std::uint8_t> packed = deflated(_open);
    _loops.blocks.push_back(_loops.bytes.size());
    _loops.bytes.insert(_loops.bytes.end(), packed.begin(), packed.end());
    _loops.blocks.push_back(_loops.bytes.size());
    _loops.bytes.resize((_loops.bytes.size() + base64_group - 1) / base64_group * base64_group);
    _open.clear();
    _orbits = 0;
  }

 private:
  Loops& _loops;
  std::vector<std::uint8_t> _open;
  std::size_t _orbits = 0;
};

/// Every n-th orbit of a family keeps its loop, n the least with which they fit into `bytes`, by estimate.
std::size_t stride_of(const archive::Archive& atlas, const std::vector<int>& angles, std::size_t bytes) {
  const std::size_t orbits = atlas.orbits().rows();
  const std::size_t every = std::max(orbits_a_block, orbits / blocks_tried);
  std::size_t size = 0;
  std::size_t count = 0;
  for (std::size_t first = 0; first < orbits; first += every) {
    std::vector<std::uint8_t> block;
    for (std::size_t orbit = first; orbit < std::min(orbits, first + orbits_a_block); ++orbit, ++count) {
      const std::vector<std::uint8_t> loop = thinned(archive::loop_of(atlas, orbit, angles), page_tolerance).bytes;
      block.insert(block.end(), loop.begin(), loop.end());
    }
    size += deflated(block).size();
  }
  if (count == 0) return 1;
  const double each = static_cast<double>(size) / static_cast<double>(count);
  const double all = each * static_cast<double>(orbits);
  return static_cast<std::size_t>(std::max(1.0, std::ceil(all / static_cast<double>(bytes))));
}

Loops loops_of(const archive::Archive& atlas, std::size_t bytes) {
  const std::vector<int> angles = angles_of(atlas);
  const std::size_t orbits = atlas.orbits().rows();
  const std::size_t stride = stride_of(atlas, angles, bytes);
  Loops loops;
  loops.begins.assign(orbits, -1);
  loops.block_of.assign(orbits, -1);
  Blocks blocks(loops);
  for (std::size_t family = 0; family < atlas.families().rows(); ++family) {
    const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
    const auto count = static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]);
    for (std::size_t place = 0; place < count; ++place) {
      const std::size_t orbit = first + place;
      const ThinnedLoop loop = thinned(archive::loop_of(atlas, orbit, angles), page_tolerance);
      loops.amplitudes.push_back(loop.amplitude);
      loops.largest.insert(loops.largest.end(), loop.largest.begin(), loop.largest.end());
      if (place % stride != 0 && place + 1 != count) continue;
      blocks.add(orbit, loop);
      ++loops.count;
      loops.harmonics_stored += static_cast<std::size_t>(atlas.orbits().integers("cutoff")[orbit]);
      loops.harmonics_kept += static_cast<std::size_t>(loop.harmonics);
      loops.deviation = std::max(loops.deviation, loop.deviation);
    }
  }
  blocks.close();
  return loops;
}

std::string element(std::string_view id, std::span<const std::uint8_t> bytes) {
  return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(bytes));
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

PageSummary write_page(std::ostream& out, const archive::Archive& atlas, std::string_view page_template,
                       std::size_t loop_bytes) {
  const std::size_t place = page_template.find(place_of_data);
  core::require(place != std::string_view::npos, "the page's template has no place for the data");
  const Loops loops = loops_of(atlas, loop_bytes);
  PageColumns columns;
  add_orbit_columns(columns, atlas);
  columns.add_float64("amplitude", loops.amplitudes, 1);
  columns.add_float64("largest", loops.largest, atlas.header().state_names.size());
  columns.add_int32("loop_block", loops.block_of);
  columns.add_int32("loop_begin", loops.begins);

  PageSummary summary;
  summary.families = atlas.families().rows();
  summary.orbits = atlas.orbits().rows();
  summary.loops = loops.count;
  summary.harmonics_kept = loops.harmonics_kept;
  summary.harmonics_stored = loops.harmonics_stored;
  summary.deviation = loops.deviation;

  const std::string index =
      fmt::format(R"({{"page":1,"orbits":{},"loops":{},"deviation":{},"harmonicsKept":{},"harmonicsStored":{},)"
                  R"("blocks":[{}],"columns":{},{}}})",
                  summary.orbits, summary.loops, json_number(summary.deviation), summary.harmonics_kept,
                  summary.harmonics_stored, fmt::join(loops.blocks, ","), columns.json(), index_members(atlas));

  const std::string loop_element = element("atlas-loops", loops.bytes);
  const std::string rest =
      element("atlas-index", deflated(bytes_of(index))) + element("atlas-columns", deflated(columns.bytes()));
  out << page_template.substr(0, place) << rest << loop_element << page_template.substr(place + place_of_data.size());
  summary.loop_bytes = loop_element.size();
  summary.bytes = page_template.size() - place_of_data.size() + rest.size() + loop_element.size();
  return summary;
}

}  // namespace orbweaver::report
