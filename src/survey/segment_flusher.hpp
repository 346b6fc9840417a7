#pragma once

#include <filesystem>
#include <vector>

#include "orbweaver/archive/records.hpp"
#include "orbweaver/core/communicator.hpp"
#include "orbweaver/queue/flusher.hpp"

namespace orbweaver::survey {

/// Writes the rows that the ranks hold into the next segment, all ranks together, and forgets them.
class SegmentFlusher : public queue::Flusher {
 public:
  SegmentFlusher(const core::Communicator& comm, std::filesystem::path folder, const archive::Header& header,
                 archive::Records& rows);

  void flush(int number) override;
  /// The segments written so far, the same list on every rank.
  [[nodiscard]] const std::vector<std::filesystem::path>& segments() const { return _segments; }

 private:
  const core::Communicator& _comm;
  std::filesystem::path _folder;
  const archive::Header& _header;
  archive::Records& _rows;
  std::vector<std::filesystem::path> _segments;
};

}  // namespace orbweaver::survey
