#include "orbweaver/core/file_hash.hpp"

#include <array>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/uuid/detail/sha1.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/input_file.hpp"

namespace orbweaver::core {

namespace {

std::string digits_of(boost::uuids::detail::sha1& hash) {
  boost::uuids::detail::sha1::digest_type digest;
  hash.get_digest(digest);
  return fmt::format("{:08x}", fmt::join(digest, ""));
}

}  // namespace

std::string text_hash(std::string_view text) {
  boost::uuids::detail::sha1 hash;
  hash.process_bytes(text.data(), text.size());
  return digits_of(hash);
}

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
  return digits_of(hash);
}

}  // namespace orbweaver::core
