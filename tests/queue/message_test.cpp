#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <boost/crc.hpp>
#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/queue/message.hpp"
#include "support/serialized.hpp"

namespace message_test {
namespace {

using namespace orbweaver::queue;
using orbweaver::core::EnvironmentError;
using testing::AllOf;
using testing::HasSubstr;

const std::string all_bytes = [] {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes.push_back(static_cast<char>(i));
  return bytes;
}();

template <class T>
T round_trip(const T& message) {
  const Message back = unpack(pack(message), "from rank 3");
  EXPECT_EQ(tag_of(back), T::tag);
  return std::get<T>(back);
}

std::string refusal(const std::string& bytes) {
  try {
    (void)unpack(bytes, "from rank 3");
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("from rank 3"));
    return error.what();
  }
  return "accepted";
}

/// The bytes of a message with this type and body, and a right checksum.
std::string forge(std::uint32_t type, const std::string& body) {
  std::string bytes = pack(Stop{}).substr(0, envelope_bytes);
  const std::uint64_t length = body.size();
  bytes.replace(12, 4, reinterpret_cast<const char*>(&type), 4);
  bytes.replace(16, 8, reinterpret_cast<const char*>(&length), 8);
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), 24);
  crc.process_bytes(body.data(), body.size());
  const std::uint32_t sum = crc.checksum();
  bytes.replace(24, 4, reinterpret_cast<const char*>(&sum), 4);
  return bytes + body;
}

TEST(Message, RoundTripOfTasksAndOutcomes) {
  const Task task{"family/1/b", -7, "branch", all_bytes, all_bytes};
  EXPECT_EQ(round_trip(Assign{task}).task, task);
  const TaskOutcome outcome{"k",       true, "because", {task, {}, {"x", std::numeric_limits<int>::min(), "", ""}},
                            all_bytes, true, all_bytes};
  const Outcome back = round_trip(Outcome{outcome, 1LL << 40});
  EXPECT_EQ(back.outcome, outcome);
  EXPECT_EQ(back.rows, 1LL << 40);
  EXPECT_EQ(round_trip(Outcome{}).outcome, TaskOutcome{});
}

template <class T>
void expect_complete() {
  EXPECT_EQ(orbweaver::test::incomplete_types_in<T>(), "");
  const T sent = orbweaver::test::filled<T>();
  EXPECT_EQ(orbweaver::test::text_of(round_trip(sent)), orbweaver::test::text_of(sent))
      << tag_name(static_cast<int>(T::tag));
}

TEST(Message, EveryMemberOfEveryMessageTravels) {
  [&]<class... T>(const std::variant<T...>*) { (expect_complete<T>(), ...); }(static_cast<const Message*>(nullptr));
}

TEST(Message, RoundTripOfProgress) {
  const Progress progress{12, 34, {1.5, -std::numeric_limits<double>::infinity(), 5e-324}};
  const ProgressReport back = round_trip(ProgressReport{"k", progress});
  EXPECT_EQ(back.key, "k");
  EXPECT_EQ(back.progress, progress);
}

TEST(Message, RoundTripOfTheOthers) {
  EXPECT_EQ(round_trip(Hello{}).version, protocol_version);
  EXPECT_EQ(round_trip(FlushRequest{3}).number, 3);
  EXPECT_EQ(round_trip(FlushReady{4, 9}).number, 4);
  EXPECT_EQ(round_trip(FlushReady{4, 9}).rows, 9);
  EXPECT_EQ(round_trip(FlushReady{4, 9, all_bytes}).state, all_bytes);
  EXPECT_EQ(round_trip(FlushGo{5}).number, 5);
  EXPECT_EQ(round_trip(FlushDone{6, "disk full"}).number, 6);
  EXPECT_EQ(round_trip(FlushDone{6, "disk full"}).error, "disk full");
  round_trip(Stop{});
  EXPECT_EQ(round_trip(Alarm{"torn"}).error, "torn");
  const Shutdown shutdown = round_trip(Shutdown{"e", 1, 2, 3, 4, true, 6, 7, 8.5});
  EXPECT_EQ(shutdown.error, "e");
  EXPECT_EQ(shutdown.done, 1u);
  EXPECT_EQ(shutdown.failed, 2u);
  EXPECT_EQ(shutdown.waiting, 3u);
  EXPECT_EQ(shutdown.stopped, 4u);
  EXPECT_TRUE(shutdown.stopped_early);
  EXPECT_EQ(shutdown.flushes, 6);
  EXPECT_EQ(shutdown.rows, 7);
  EXPECT_EQ(shutdown.seconds, 8.5);
  EXPECT_EQ(round_trip(EndTask{"k"}).key, "k");
  EXPECT_EQ(round_trip(Goodbye{10, 0.25}).tasks, 10);
  EXPECT_EQ(round_trip(Goodbye{10, 0.25}).busy_seconds, 0.25);
}

TEST(Message, PayloadsOfAnySize) {
  std::mt19937 random(1);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{4095}, std::size_t{4096}, std::size_t{5'000'003}}) {
    std::string payload(size, '\0');
    for (char& byte : payload) byte = static_cast<char>(random());
    EXPECT_EQ(round_trip(Assign{{"k", 0, "", payload}}).task.payload, payload) << size;
    EXPECT_LE(pack(Assign{{"k", 0, "", payload}}).size(), size + 100) << "little may be added to the payload";
  }
}

TEST(Message, EveryTruncationIsRefused) {
  const std::string bytes = pack(Assign{{"key", 1, "kind", "payload"}});
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THAT(refusal(bytes.substr(0, length)), HasSubstr("torn")) << length;
  EXPECT_THAT(refusal(bytes + "x"), HasSubstr("torn"));
}

TEST(Message, EveryFlippedBitIsRefused) {
  const std::string bytes = pack(Outcome{{"key", false, "", {{"child", 1, "kind", "p"}}, "payload", false}, 5});
  for (std::size_t i = 0; i < 8 * bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i / 8] = static_cast<char>(flipped[i / 8] ^ (1 << (i % 8)));
    EXPECT_NE(refusal(flipped), "accepted") << "bit " << i;
  }
}

TEST(Message, RefusalsSayWhatIsWrong) {
  std::string bytes = pack(FlushGo{1});
  std::string foreign = bytes;
  foreign.replace(0, 8, "somebody");
  EXPECT_THAT(refusal(foreign), HasSubstr("somebody else sends on this communicator"));
  EXPECT_THAT(refusal(std::string(100, '\0')), HasSubstr("somebody else"));
  std::string newer = bytes;
  newer[8] = static_cast<char>(message_format_version + 1);
  EXPECT_THAT(refusal(newer),
              AllOf(HasSubstr(fmt::format("format version is {}", message_format_version + 1)),
                    HasSubstr(fmt::format("reads version {}", message_format_version)),
                    HasSubstr("same newer orbweaver")));
  bytes.back() = static_cast<char>(bytes.back() ^ 0x10);
  EXPECT_THAT(refusal(bytes), HasSubstr("checksum"));
}

TEST(Message, BodiesThatDoNotFitTheirTypeAreRefused) {
  EXPECT_EQ(refusal(forge(static_cast<std::uint32_t>(Tag::stop), "")), "accepted");
  EXPECT_THAT(refusal(forge(0, "")), HasSubstr("type 0 is not one of 1 to 13"));
  EXPECT_THAT(refusal(forge(14, "")), HasSubstr("type 14"));
  EXPECT_THAT(refusal(forge(static_cast<std::uint32_t>(Tag::flush_go), "ab")), HasSubstr("its body is no flush_go"));
  EXPECT_THAT(refusal(forge(static_cast<std::uint32_t>(Tag::alarm), std::string(8, '\xff'))),
              HasSubstr("its body is no alarm"));
  EXPECT_THAT(refusal(forge(static_cast<std::uint32_t>(Tag::stop), "abc")), HasSubstr("3 bytes follow its body"));
}

TEST(Message, TagsHaveNames) {
  EXPECT_EQ(tag_name(static_cast<int>(Tag::hello)), "hello");
  EXPECT_EQ(tag_name(static_cast<int>(Tag::progress)), "progress");
  EXPECT_EQ(tag_name(static_cast<int>(Tag::goodbye)), "goodbye");
  EXPECT_EQ(tag_name(static_cast<int>(Tag::end_task)), "end_task");
  EXPECT_EQ(tag_name(77), "tag 77");
  EXPECT_EQ(tag_name(0), "tag 0");
}

}  // namespace
}  // namespace message_test
