#pragma once

#include <filesystem>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/flusher.hpp"
#include "state/payload_store.hpp"

namespace orbweaver::survey {

/// Writes the rows that the ranks hold into the next segment, all ranks together, and forgets them, when the payloads
/// that they have kept are on the disk.
class SegmentFlusher : public queue::Flusher {
 public:
  /// `written`: those that are there already, on rank 0. Collective.
  SegmentFlusher(const core::Communicator& comm, std::filesystem::path folder, const archive::Header& header,
                 archive::Records& rows, std::vector<archive::WrittenSegment> written, PayloadStore& store);

  void flush(int number) override;
  /// On rank 0.
  [[nodiscard]] const std::vector<archive::WrittenSegment>& written() const { return _written; }

 private:
  const core::Communicator& _comm;
  std::filesystem::path _folder;
  const archive::Header& _header;
  archive::Records& _rows;
  std::vector<archive::WrittenSegment> _written;
  PayloadStore& _store;
  unsigned long _last_number = 0;
};

}  // namespace orbweaver::survey
