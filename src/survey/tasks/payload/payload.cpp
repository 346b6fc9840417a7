#include "payload.hpp"

#include <cstring>
#include <exception>
#include <sstream>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/append_buffer.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::survey {

namespace {

// The head before it says more, and is read within its bytes.
constexpr unsigned archive_flags = boost::archive::no_header | boost::archive::no_codecvt;

// Of a foreign name, in a message; ours are shorter.
constexpr std::size_t longest_name = 40;

constexpr const char* same_build =
    "all ranks, and whoever wrote the files of a survey, must be the same build of Orbweaver";

void expect(const PayloadType& type, boost::archive::binary_iarchive& archive) {
  std::string name;
  int version = 0;
  core::serialize_member(archive, name);
  archive >> version;
  if (name != type.name || version != type.version)
    throw core::EnvironmentError(fmt::format("expected a {} of version {}, got a {} of version {}: {}", type.name,
                                             type.version, core::printable(core::shortened(name, longest_name)),
                                             version, same_build));
  std::uint64_t layout = 0;
  archive >> layout;
  if (layout != type.layout)
    throw core::EnvironmentError(
        fmt::format("a {} of version {} has other members than here: {}", type.name, type.version, same_build));
}

}  // namespace

bool is_named(const PayloadType& type, const std::string& bytes) {
  const std::string_view name = type.name;
  std::uint64_t length = 0;  // as a text's stands before it (core/serialization.hpp)
  if (bytes.size() < sizeof length + name.size()) return false;
  std::memcpy(&length, bytes.data(), sizeof length);
  return length == name.size() && std::string_view(bytes).substr(sizeof length, name.size()) == name;
}

std::string write_payload(const PayloadType& type, const std::function<void(boost::archive::binary_oarchive&)>& write) {
  const auto write_to = [&](std::streambuf& buffer) {
    boost::archive::binary_oarchive archive(buffer, archive_flags);
    std::string name = type.name;
    core::serialize_member(archive, name);
    archive << type.version << type.layout;
    write(archive);
  };
  core::CountingBuffer count;  // a checkpoint's bytes, grown as they come, would be there three times
  write_to(count);
  std::string bytes;
  bytes.reserve(count.bytes());
  core::AppendBuffer buffer(bytes);
  write_to(buffer);
  return bytes;
}

void read_payload(const PayloadType& type, const std::string& bytes,
                  const std::function<void(boost::archive::binary_iarchive&)>& read) {
  try {
    std::istringstream stream(bytes);
    boost::archive::binary_iarchive archive(stream, archive_flags);
    expect(type, archive);
    read(archive);
    if (stream.peek() != std::istringstream::traits_type::eof())
      throw core::EnvironmentError(
          fmt::format("a {} of {} bytes has more bytes than its own", type.name, bytes.size()));
  } catch (const core::EnvironmentError&) {
    throw;
  } catch (const std::exception& error) {  // foreign bytes may also ask Boost for texts of impossible length
    throw core::EnvironmentError(
        fmt::format("a {} of {} bytes cannot be read: {}", type.name, bytes.size(), error.what()));
  }
}

}  // namespace orbweaver::survey
