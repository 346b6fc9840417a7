#include "segment_flusher.hpp"

#include <utility>

#include <fmt/format.h>

#include "orbweaver/archive/segment.hpp"
#include "orbweaver/core/check.hpp"

namespace orbweaver::survey {

SegmentFlusher::SegmentFlusher(const core::Communicator& comm, std::filesystem::path folder,
                               const archive::Header& header, archive::Records& rows)
    : _comm(comm), _folder(std::move(folder)), _header(header), _rows(rows) {}

void SegmentFlusher::flush(int) {
  const long mine = static_cast<long>(_rows.orbits.size() + _rows.sections.size());
  long all = 0;
  core::check_mpi(MPI_Allreduce(&mine, &all, 1, MPI_LONG, MPI_SUM, _comm.get()), "MPI_Allreduce");
  if (all == 0) return;
  const std::filesystem::path path = _folder / fmt::format("segment-{:06}.h5", _segments.size() + 1);
  archive::write_segment(_comm.get(), path, _header, _rows);
  _segments.push_back(path);
  _rows = {};
}

}  // namespace orbweaver::survey
