#include "orbweaver/queue/message.hpp"

#include <array>
#include <cstring>
#include <streambuf>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include "orbweaver/core/append_buffer.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/queue/boost_serialization.hpp"

namespace orbweaver::queue {

namespace {

constexpr std::string_view magic{"ORBWMSG\x1a", 8};
constexpr std::size_t checked_header = envelope_bytes - sizeof(std::uint32_t);
constexpr unsigned archive_flags = boost::archive::no_header | boost::archive::no_codecvt;

constexpr std::array<std::string_view, 13> tag_names{
    "hello",      "assign", "outcome", "progress", "flush_request", "flush_ready", "flush_go",
    "flush_done", "stop",   "alarm",   "shutdown", "goodbye",       "end_task"};
static_assert(tag_names.size() == std::variant_size_v<Message>);

class ReadBuffer : public std::streambuf {
 public:
  explicit ReadBuffer(std::string_view bytes) {
    char* begin = const_cast<char*>(bytes.data());
    setg(begin, begin, begin + bytes.size());
  }
  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(egptr() - gptr()); }
};

template <class T>
void put(std::string& bytes, std::size_t place, T value) {
  std::memcpy(bytes.data() + place, &value, sizeof(T));
}

template <class T>
T take(std::string_view& bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes.remove_prefix(sizeof(T));
  return value;
}

std::uint32_t checksum(std::string_view header, std::string_view body) {
  const auto add = [](unsigned long crc, std::string_view bytes) {
    return crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  };
  return static_cast<std::uint32_t>(add(add(0, header), body));
}

[[noreturn]] void refuse(std::string_view where, const std::string& what) {
  throw core::EnvironmentError(fmt::format("the message {} cannot be used: {}", where, what));
}

struct Opened {
  std::uint32_t type;
  std::string_view body;
};

Opened open_envelope(std::string_view bytes, std::string_view where) {
  if (bytes.size() < envelope_bytes)
    refuse(where, fmt::format("expected at least {} bytes, got {}; it is torn", envelope_bytes, bytes.size()));
  std::string_view rest = bytes;
  if (rest.substr(0, magic.size()) != magic)
    refuse(where, "it does not begin with the queue's mark; somebody else sends on this communicator");
  rest.remove_prefix(magic.size());
  const auto version = take<std::uint32_t>(rest);
  if (version != message_format_version)
    refuse(
        where,
        fmt::format("its format version is {}, this rank reads version {}; start all ranks with the same {} orbweaver",
                    version, message_format_version, version > message_format_version ? "newer" : "current"));
  const auto type = take<std::uint32_t>(rest);
  const auto length = take<std::uint64_t>(rest);
  const auto expected = take<std::uint32_t>(rest);
  if (length != rest.size())
    refuse(where, fmt::format("its body should have {} bytes and has {}; it is torn", length, rest.size()));
  const std::uint32_t found = checksum(bytes.substr(0, checked_header), rest);
  if (found != expected)
    refuse(where,
           fmt::format("its checksum should be {:08x} and is {:08x}; it was changed on its way", expected, found));
  return {type, rest};
}

template <class T>
Message decode(std::string_view body, std::string_view where) {
  T message;
  ReadBuffer buffer(body);
  try {
    boost::archive::binary_iarchive archive(buffer, archive_flags);
    archive >> message;
  } catch (const std::exception& error) {
    refuse(where, fmt::format("its body is no {} ({})", tag_name(static_cast<int>(T::tag)), error.what()));
  }
  if (buffer.left() != 0)
    refuse(where, fmt::format("{} bytes follow its body, a {}", buffer.left(), tag_name(static_cast<int>(T::tag))));
  return message;
}

using Decoder = Message (*)(std::string_view, std::string_view);

template <std::size_t... I>
constexpr std::array<Decoder, sizeof...(I)> make_decoders(std::index_sequence<I...>) {
  static_assert(((static_cast<std::size_t>(std::variant_alternative_t<I, Message>::tag) == I + 1) && ...),
                "the tags are numbered from 1 in the order of Message");
  return {&decode<std::variant_alternative_t<I, Message>>...};
}

}  // namespace

Tag tag_of(const Message& message) {
  return std::visit([](const auto& m) { return m.tag; }, message);
}

std::string tag_name(int tag) {
  const bool ours = tag >= 1 && static_cast<std::size_t>(tag) <= tag_names.size();
  return ours ? std::string(tag_names[static_cast<std::size_t>(tag) - 1]) : fmt::format("tag {}", tag);
}

std::string pack(const Message& message) {
  std::string bytes(envelope_bytes, '\0');
  {
    core::AppendBuffer buffer(bytes);
    boost::archive::binary_oarchive archive(buffer, archive_flags);
    std::visit([&archive](const auto& m) { archive << m; }, message);
  }
  const std::string_view body = std::string_view(bytes).substr(envelope_bytes);
  bytes.replace(0, magic.size(), magic);
  put(bytes, 8, message_format_version);
  put(bytes, 12, static_cast<std::uint32_t>(tag_of(message)));
  put(bytes, 16, static_cast<std::uint64_t>(body.size()));
  put(bytes, checked_header, checksum(std::string_view(bytes).substr(0, checked_header), body));
  return bytes;
}

Message unpack(std::string_view bytes, std::string_view where) {
  static constexpr auto decoders = make_decoders(std::make_index_sequence<std::variant_size_v<Message>>());
  const auto [type, body] = open_envelope(bytes, where);
  if (type < 1 || type > decoders.size())
    refuse(where, fmt::format("its type {} is not one of 1 to {}", type, decoders.size()));
  return decoders[type - 1](body, where);
}

}  // namespace orbweaver::queue
