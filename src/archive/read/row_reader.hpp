#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "file/segment_file.hpp"

namespace orbweaver::archive {

/// A row of a segment that belongs at `target` of a block.
struct RowSource {
  std::int64_t segment = 0;
  std::int64_t row = 0;
  std::size_t target = 0;
};

/// Rows that lie next to each other in one segment.
struct Run {
  const SegmentFile& segment;
  std::uint64_t first;
  const RowSource* begin;
  const RowSource* end;
  [[nodiscard]] std::uint64_t count() const { return static_cast<std::uint64_t>(end - begin); }
};

/// Sorts `sources` by segment and row, opens each segment once and calls `visit` for each run.
void for_each_run(const std::vector<std::string>& segments, std::vector<RowSource> sources,
                  const std::function<void(const Run&)>& visit);

/// Reads the run's rows of each column that `stored` (the segment's table) and `block` share, except `without`, into
/// their targets.
void read_columns(const Run& run, const TableSpec& stored, const std::vector<std::string>& without, Table& block);

}  // namespace orbweaver::archive
