#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/core/mpi/collective.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "file/parallel_file.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "read/row_reader.hpp"
#include "root_tables.hpp"
#include "schema/check_records.hpp"
#include "schema/columns.hpp"
#include "schema/row_checksum.hpp"

namespace orbweaver::archive {

namespace {

// Doubles that a row costs besides its modes, in the balance of work and memory.
constexpr std::uint64_t row_weight = 64;

// What rank 0 gave, on every rank.
struct Order {
  std::vector<std::string> segments;
  std::string output;
  Header header;
  Selection selection;
  std::vector<CertificateRecord> certificates;
  std::uint64_t block_values = 0;
};

Order share_order(MPI_Comm comm, Order order) {
  Header& header = order.header;
  std::vector<std::string> texts{order.output, header.orbweaver_version, header.scene, header.system, header.model};
  order.segments = core::agreed(comm, std::move(order.segments));
  texts = core::agreed(comm, std::move(texts));
  header.state_names = core::agreed(comm, std::move(header.state_names));
  header.winding_names = core::agreed(comm, std::move(header.winding_names));
  header.winding_coordinates = core::gather_rows(comm, header.winding_coordinates);  // only rank 0 has any
  header.effects = core::agreed(comm, std::move(header.effects));
  header.parameter_names = core::agreed(comm, std::move(header.parameter_names));
  header.parameter_values = core::gather_rows(comm, header.parameter_values);
  header.scale_names = core::agreed(comm, std::move(header.scale_names));
  header.scales = core::gather_rows(comm, header.scales);
  order.selection.keys = core::agreed(comm, std::move(order.selection.keys));
  order.selection.left_out = core::agreed(comm, std::move(order.selection.left_out));
  order.selection.voided_keys = core::agreed(comm, std::move(order.selection.voided_keys));
  order.selection.earlier_scenes = core::agreed(comm, std::move(order.selection.earlier_scenes));
  order.selection.steps = core::gather_rows(comm, order.selection.steps);  // only rank 0 has any
  order.selection.births = core::gather_rows(comm, order.selection.births);
  order.selection.voided = core::gather_rows(comm, order.selection.voided);
  order.certificates = core::gather_rows(comm, order.certificates);
  order.output = texts[0];
  header.orbweaver_version = texts[1];
  header.scene = texts[2];
  header.system = texts[3];
  header.model = texts[4];
  header.pairs = core::agreed(comm, header.pairs);
  header.symplectic = core::agreed(comm, header.symplectic);
  order.block_values = core::agreed(comm, order.block_values);
  return order;
}

struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;
};

// Cuts rows 0 ... n into blocks whose weight all ranks can hold together, and each block into the ranks' shares.
class Blocks {
 public:
  Blocks(MPI_Comm comm, std::vector<std::uint64_t> weight_before, std::uint64_t rank_budget)
      : _weight_before(std::move(weight_before)),
        _rank(static_cast<std::uint64_t>(core::rank_of(comm))),
        _ranks(static_cast<std::uint64_t>(core::size_of(comm))),
        _budget(_ranks * std::max<std::uint64_t>(rank_budget, 1)) {}

  /// This rank's rows of the next block; false after the last.
  bool next(Range& mine) {
    const std::size_t rows = _weight_before.size() - 1;
    if (_at == rows) return false;
    const std::size_t end = std::clamp(position(_weight_before[_at] + _budget), _at + 1, rows);
    const std::uint64_t weight = _weight_before[end] - _weight_before[_at];
    const auto cut = [&](std::uint64_t rank) { return position(_weight_before[_at] + weight * rank / _ranks); };
    mine = {_rank == 0 ? _at : cut(_rank), _rank + 1 == _ranks ? end : cut(_rank + 1)};
    _at = end;
    return true;
  }

 private:
  [[nodiscard]] std::size_t position(std::uint64_t weight) const {
    const auto found = std::lower_bound(_weight_before.begin(), _weight_before.end(), weight);
    return static_cast<std::size_t>(found - _weight_before.begin());
  }

  std::vector<std::uint64_t> _weight_before;
  std::uint64_t _rank;
  std::uint64_t _ranks;
  std::uint64_t _budget;
  std::size_t _at = 0;
};

template <class Row>
std::vector<RowSource> sources_of(const std::vector<Row>& rows, Range range) {
  std::vector<RowSource> sources;
  for (std::size_t i = range.begin; i < range.end; ++i)
    sources.push_back({rows[i].segment, rows[i].row, i - range.begin});
  return sources;
}

// A flat dataset's part that belongs to a range of orbits.
class Values {
 public:
  Values(const Numbering& numbering, Range range, const std::vector<std::uint64_t>& at, std::int64_t OrbitRow::*begin,
         std::int64_t OrbitRow::*count)
      : _numbering(numbering),
        _range(range),
        _at(at),
        _begin(begin),
        _count(count),
        _values(at[range.end] - at[range.begin]) {}

  void read(const Run& run, const std::string& name) {
    const OrbitRow& first = orbit(run.begin[0]);
    const OrbitRow& last = orbit(run.end[-1]);
    const auto begin = static_cast<std::uint64_t>(first.*_begin);
    const std::vector<double> stored =
        run.segment.file().read_flat(name, begin, static_cast<std::uint64_t>(last.*_begin + last.*_count) - begin);
    for (const RowSource* source = run.begin; source != run.end; ++source) {
      const OrbitRow& row = orbit(*source);
      std::copy_n(stored.begin() + (row.*_begin - first.*_begin), row.*_count,
                  _values.begin() + static_cast<std::ptrdiff_t>(_at[_range.begin + source->target] - first_value()));
    }
  }

  /// Of the orbit at `target` of the range.
  [[nodiscard]] std::span<const double> of(std::size_t target) const {
    const std::size_t row = _range.begin + target;
    return std::span(_values).subspan(_at[row] - first_value(), _at[row + 1] - _at[row]);
  }

  [[nodiscard]] std::uint64_t first_value() const { return _at[_range.begin]; }
  [[nodiscard]] const std::vector<double>& get() const { return _values; }

 private:
  [[nodiscard]] const OrbitRow& orbit(const RowSource& source) const {
    return _numbering.orbits[_range.begin + source.target];
  }

  const Numbering& _numbering;
  Range _range;
  const std::vector<std::uint64_t>& _at;
  std::int64_t OrbitRow::*_begin;
  std::int64_t OrbitRow::*_count;
  std::vector<double> _values;
};

void number_orbits(Table& block, const Numbering& numbering, Range range) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    block.integers("family")[i - range.begin] = numbering.orbits[i].family;
    block.integers("modes_begin")[i - range.begin] = static_cast<std::int64_t>(numbering.modes_at[i]);
    block.integers("time_map_begin")[i - range.begin] = static_cast<std::int64_t>(numbering.maps_at[i]);
  }
}

// Segments have those of steps below zero from the family's birth.
void set_arclengths(Table& block, const Order& order, const Numbering& numbering, Range range) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const OrbitRow& orbit = numbering.orbits[i];
    const double birth = order.selection.births[static_cast<std::size_t>(orbit.family)];
    if (orbit.step < 0 && !std::isnan(birth)) block.reals("arclength")[i - range.begin] += birth;
  }
}

// A row from before there were checksums gets one.
void check_values(const Run& run, const RowSource& source, Table& block, const std::string& name,
                  const Values& values) {
  std::int64_t& stored = block.integers(name + "_checksum")[source.target];
  const std::int64_t sum = values_checksum(values.of(source.target));
  if (run.segment.file().has_checksums())
    run.segment.file().expect(stored == sum, changed_values(name, static_cast<std::size_t>(source.row)));
  stored = sum;
}

void write_orbits(MPI_Comm comm, ParallelFile& file, const Order& order, const Numbering& numbering) {
  std::vector<std::uint64_t> weight(numbering.modes_at.size());
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight[i] = numbering.modes_at[i] + numbering.maps_at[i] + row_weight * i;
  Blocks blocks(comm, std::move(weight), order.block_values);
  for (Range mine; blocks.next(mine);) {
    Table block;
    Values modes(numbering, mine, numbering.modes_at, &OrbitRow::modes_begin, &OrbitRow::modes_count);
    Values maps(numbering, mine, numbering.maps_at, &OrbitRow::map_begin, &OrbitRow::map_count);
    core::collectively(comm, [&] {
      block = Table(orbits_spec(order.header), mine.end - mine.begin);
      number_orbits(block, numbering, mine);
      for_each_run(order.segments, sources_of(numbering.orbits, mine), [&](const Run& run) {
        read_columns(run, run.segment.orbits_spec(), {"family_key", "modes_begin", "time_map_begin"}, block);
        modes.read(run, "modes");
        maps.read(run, "time_maps");
        for (const RowSource* source = run.begin; source != run.end; ++source) {
          check_values(run, *source, block, "modes", modes);
          check_values(run, *source, block, "time_map", maps);
        }
      });
      set_arclengths(block, order, numbering, mine);
      if (!order.certificates.empty())
        fill_columns(block, certificate_columns(),
                     [&](std::size_t row) -> const CertificateRecord& { return order.certificates[mine.begin + row]; });
      set_checksums(block, mine.begin);
    });
    file.write_table(block, mine.begin);
    file.write_flat("modes", modes.get(), modes.first_value());
    file.write_flat("time_maps", maps.get(), maps.first_value());
  }
}

void write_sections(MPI_Comm comm, ParallelFile& file, const Order& order, const Numbering& numbering) {
  std::vector<std::uint64_t> weight(numbering.sections.size() + 1);
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = i * (2 + order.header.state_names.size());
  Blocks blocks(comm, std::move(weight), order.block_values);
  for (Range mine; blocks.next(mine);) {
    Table block;
    core::collectively(comm, [&] {
      block = Table(sections_spec(order.header), mine.end - mine.begin);
      for (std::size_t i = mine.begin; i < mine.end; ++i)
        block.integers("orbit")[i - mine.begin] = numbering.sections[i].orbit;
      for_each_run(order.segments, sources_of(numbering.sections, mine), [&](const Run& run) {
        read_columns(run, run.segment.sections_spec(), {"family_key", "step"}, block);
      });
      set_checksums(block, mine.begin);
    });
    file.write_table(block, mine.begin);
  }
}

void check_input(MPI_Comm comm, const Header& header, const Records& tables, std::size_t segments) {
  core::collectively(comm, [&] {
    if (core::rank_of(comm) != 0) return;
    core::require(tables.orbits.empty() && tables.sections.empty(),
                  "consolidate takes orbits and sections from segments: write them with write_segment");
    check_header(header);
    check_families(tables);
    check_crossings(header, tables);
    check_loci(header, tables);
    check_equilibria(header, tables);
    check_voided(tables, segments);
  });
}

}  // namespace

bool consolidate(MPI_Comm comm, const std::vector<std::filesystem::path>& segments, const std::filesystem::path& output,
                 const Header& header, const Records& tables, const ConsolidateOptions& options,
                 const Witness& witness) {
  const core::LogStage stage(core::Stage::archive);
  const bool is_root = core::rank_of(comm) == 0;
  check_input(comm, header, tables, segments.size());
  Order given;
  if (is_root) {
    given = {{}, output.string(), header, selection_of(tables), tables.certificates, options.block_values};
    for (const auto& path : segments) given.segments.push_back(path.string());
  }
  const Order order = share_order(comm, std::move(given));
  const Numbering numbering = number_rows(comm, order.segments, order.header, order.selection);
  core::require(order.certificates.empty() || order.certificates.size() == numbering.orbits.size(),
                "an atlas takes a certificate for each of its orbits, or none");
  RootTables root;
  core::collectively(comm, [&] {
    root = make_root_tables(order.header, is_root ? tables : Records{},
                            is_root ? order.selection.keys : std::vector<std::string>{},
                            is_root ? order.header.model : std::string(), numbering);
  });

  agree_on_text_widths(comm, root.families);
  agree_on_text_widths(comm, root.crossings);
  agree_on_text_widths(comm, root.loci);
  agree_on_text_widths(comm, root.equilibria);
  agree_on_text_widths(comm, root.model);
  const std::uint64_t families = core::greatest(comm, root.families.rows());
  const std::uint64_t crossings = core::greatest(comm, root.crossings.rows());
  const std::uint64_t loci = core::greatest(comm, root.loci.rows());
  const std::uint64_t equilibria = core::greatest(comm, root.equilibria.rows());

  ParallelFile file(comm, order.output,
                    {atlas_format,
                     order.header,
                     {{root.families.spec(), families},
                      {orbits_spec(order.header), numbering.orbits.size()},
                      {root.crossings.spec(), crossings},
                      {sections_spec(order.header), numbering.sections.size()},
                      {root.loci.spec(), loci},
                      {root.equilibria.spec(), equilibria},
                      {root.model.spec(), order.header.model.empty() ? 0 : 1}},
                     {{modes_spec(), numbering.modes_at.back()}, {time_maps_spec(), numbering.maps_at.back()}}});
  file.write_table(root.families, 0);
  file.write_table(root.crossings, 0);
  file.write_table(root.loci, 0);
  file.write_table(root.equilibria, 0);
  file.write_table(root.model, 0);
  write_orbits(comm, file, order, numbering);
  write_sections(comm, file, order, numbering);
  std::optional<std::vector<FindingRecord>> findings(std::in_place);
  if (witness) findings = witness(file.pause());
  if (!findings) return false;
  Table rows = make_findings(is_root ? *findings : std::vector<FindingRecord>{});
  agree_on_text_widths(comm, rows);
  file.add_table(rows);
  file.publish();
  return true;
}

}  // namespace orbweaver::archive
