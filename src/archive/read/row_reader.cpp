#include "row_reader.hpp"

#include <algorithm>
#include <tuple>

namespace orbweaver::archive {

namespace {

void scatter(const Run& run, const Column& from, Column& to) {
  const std::size_t width = to.spec.width();
  std::visit(
      [&](auto& target) {
        const auto& source = std::get<std::decay_t<decltype(target)>>(from.values);
        for (std::uint64_t i = 0; i < run.count(); ++i)
          std::copy_n(source.begin() + static_cast<std::ptrdiff_t>(i * width), width,
                      target.begin() + static_cast<std::ptrdiff_t>(run.begin[i].target * width));
      },
      to.values);
}

}  // namespace

void for_each_run(const std::vector<std::string>& segments, std::vector<RowSource> sources,
                  const std::function<void(const Run&)>& visit) {
  std::sort(sources.begin(), sources.end(),
            [](const auto& a, const auto& b) { return std::tie(a.segment, a.row) < std::tie(b.segment, b.row); });
  const RowSource* const end = sources.data() + sources.size();
  for (const RowSource* at = sources.data(); at != end;) {
    const std::int64_t index = at->segment;
    const SegmentFile segment(segments[static_cast<std::size_t>(index)]);
    while (at != end && at->segment == index) {
      const RowSource* next = at + 1;
      while (next != end && next->segment == index && next->row == (next - 1)->row + 1) ++next;
      visit({segment, static_cast<std::uint64_t>(at->row), at, next});
      at = next;
    }
  }
}

void read_columns(const Run& run, const TableSpec& stored, const std::vector<std::string>& without, Table& block) {
  for (const ColumnSpec& spec : stored.columns) {
    if (std::find(without.begin(), without.end(), spec.name) != without.end()) continue;
    scatter(run, run.segment.file().read(stored.name, spec, run.first, run.count()), block.column(spec.name));
  }
}

}  // namespace orbweaver::archive
