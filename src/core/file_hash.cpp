#include "orbweaver/core/file_hash.hpp"

#include <array>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/uuid/detail/sha1.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/input_file.hpp"

namespace orbweaver::core {

std::string file_hash(const std::vector<std::filesystem::path>& files) {
  boost::uuids::detail::sha1 hash;
  for (const std::filesystem::path& file : files) {
    if (const std::string problem = input_problem(file); !problem.empty())
      throw InputError(fmt::format("'{}' {}", file.string(), problem));
    std::ifstream stream(file, std::ios::binary);
    std::array<char, 65536> bytes;
    while (stream.read(bytes.data(), bytes.size()) || stream.gcount() > 0)
      hash.process_bytes(bytes.data(), static_cast<std::size_t>(stream.gcount()));
  }
  boost::uuids::detail::sha1::digest_type digest;
  hash.get_digest(digest);
  return fmt::format("{:08x}", fmt::join(digest, ""));
}

}  // namespace orbweaver::core
