#include "segment_flusher.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/collective.hpp"

namespace orbweaver::survey {

SegmentFlusher::SegmentFlusher(const core::Communicator& comm, std::filesystem::path folder,
                               const archive::Header& header, archive::Records& rows,
                               std::vector<archive::WrittenSegment> written, PayloadStore& store)
    : _comm(comm),
      _folder(std::move(folder)),
      _header(header),
      _rows(rows),
      _written(std::move(written)),
      _store(store) {
  for (const archive::WrittenSegment& segment : _written)
    _last_number = std::max(_last_number, std::stoul(segment.name.substr(segment.name.find('-') + 1)));
  _last_number = core::agreed(comm.get(), _last_number);
}

void SegmentFlusher::flush(int) {
  core::collectively(_comm.get(), [&] { _store.sync(); });
  if (core::share_of(_comm.get(), _rows.orbits.size() + _rows.sections.size()).total == 0) return;
  const std::filesystem::path path = _folder / fmt::format("segment-{:06}.h5", ++_last_number);
  const auto began = std::chrono::steady_clock::now();
  const archive::WrittenSegment written = archive::write_segment(_comm.get(), path, _header, _rows);
  const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - began;
  if (_comm.is_root()) {
    core::log_debug(fmt::format("{}: {} orbits, {} bytes in {:.1f} ms", written.name, written.orbits, written.bytes,
                                passed.count()));
    _written.push_back(written);
  }
  _rows = {};
}

}  // namespace orbweaver::survey
