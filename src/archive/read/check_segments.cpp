#include "orbweaver/archive/read/check_segments.hpp"
#include "orbweaver/core/mpi/collective.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"

namespace orbweaver::archive {

namespace {

// A WrittenSegment without its name, to be sent.
struct Listed {
  std::uint64_t bytes = 0;
  std::uint64_t orbits = 0;
  std::uint64_t sections = 0;
  std::uint64_t fingerprint = 0;
};

struct Complaint {
  std::size_t segment = 0;
  std::size_t length = 0;
};

// Empty if the segment is the one that was listed.
std::string complaint_about(const std::filesystem::path& path, const Listed& listed,
                            const std::vector<std::string>& scenes) {
  const auto say = [&](const std::string& problem) { return fmt::format("'{}' {}.", path.string(), problem); };
  std::error_code code;
  const auto bytes = std::filesystem::file_size(path, code);
  if (!code && bytes != listed.bytes)
    return say(fmt::format("has {} bytes; {} were written: it is torn, or another file", bytes, listed.bytes));
  SegmentInfo found;
  try {
    found = inspect_segment(path);
  } catch (const core::InputError& error) {
    return error.what();
  }
  if (found.orbits != listed.orbits || found.sections != listed.sections)
    return say(fmt::format("holds {} orbits and {} section points; {} and {} were written: it is another segment",
                           found.orbits, found.sections, listed.orbits, listed.sections));
  if (std::find(scenes.begin(), scenes.end(), found.header.scene) == scenes.end())
    return say("was written for another scene");
  if (found.fingerprint != listed.fingerprint)
    return say("holds other orbits than were written: it is another segment");
  return "";
}

}  // namespace

std::vector<std::string> check_segments(MPI_Comm comm, const std::filesystem::path& folder,
                                        const std::vector<WrittenSegment>& listed,
                                        const std::vector<std::string>& scenes) {
  const core::LogStage stage(core::Stage::archive);
  std::vector<std::string> paths;
  std::vector<Listed> facts;
  if (core::rank_of(comm) == 0)
    for (const WrittenSegment& segment : listed) {
      paths.push_back((folder / segment.name).string());
      facts.push_back({segment.bytes, segment.orbits, segment.sections, segment.fingerprint});
    }
  std::vector<std::string> allowed = scenes;
  paths = core::agreed(comm, std::move(paths));
  allowed = core::agreed(comm, std::move(allowed));
  facts = core::gather_rows(comm, facts);  // only rank 0 has any

  std::vector<Complaint> mine;
  std::vector<char> my_text;
  core::collectively(comm, [&] {
    const auto stride = static_cast<std::size_t>(core::size_of(comm));
    for (auto i = static_cast<std::size_t>(core::rank_of(comm)); i < paths.size(); i += stride) {
      const std::string text = complaint_about(paths[i], facts[i], allowed);
      if (text.empty()) continue;
      mine.push_back({i, text.size()});
      my_text.insert(my_text.end(), text.begin(), text.end());
    }
  });
  const std::vector<Complaint> complaints = core::gather_rows(comm, mine);
  const std::vector<char> text = core::gather_rows(comm, my_text);
  std::vector<std::string> by_segment(paths.size());
  auto at = text.begin();
  for (const Complaint& complaint : complaints) {
    const auto end = at + static_cast<std::ptrdiff_t>(complaint.length);
    by_segment[complaint.segment].assign(at, end);
    at = end;
  }
  std::erase(by_segment, "");
  return by_segment;
}

}  // namespace orbweaver::archive
