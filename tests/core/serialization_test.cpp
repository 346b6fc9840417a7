#include "orbweaver/core/serialization.hpp"

#include <cstdint>
#include <optional>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/layout.hpp"
#include "support/serialized.hpp"

namespace serialization_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;

enum class Colour { red, green, blue };
[[nodiscard]] constexpr Colour last_of(Colour) { return Colour::blue; }

struct Part {
  double value = 0.0;
  Colour colour = Colour::red;

  static constexpr int wire_version = 3;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, value, colour);
  }
};

struct Whole {
  std::string name;
  std::vector<Part> parts;
  std::optional<Colour> colour;
  bool flag = false;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, name, parts, colour, flag);
  }
};

struct Forgetful {
  Part part;
  int first = 0;
  int second = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, part, first);
  }
};

struct Repeating {
  Forgetful forgetful;
  int first = 0;
  int second = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, forgetful, first, first);
  }
};

struct Numbers {
  bool flag = false;
  int signed_one = 0;
  unsigned unsigned_one = 0;
  std::uint64_t longer = 0;
  float real = 0.0F;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, flag, signed_one, unsigned_one, longer, real);
  }
};

/// An archive of one number, which may be absent.
template <bool loads>
struct OneNumber {
  using is_loading = std::bool_constant<loads>;
  int number = 0;
  unsigned char present = 0;
  OneNumber& operator&(unsigned char& value) {
    (loads ? value : present) = loads ? present : value;
    return *this;
  }
  OneNumber& operator&(int& value) {
    (loads ? value : number) = loads ? number : value;
    return *this;
  }
};

TEST(Serialization, EnumsTravelAsNumbers) {
  OneNumber<false> out;
  Colour colour = Colour::green;
  core::serialize_members(out, colour);
  EXPECT_EQ(out.number, 1);
  OneNumber<true> in{2};
  core::serialize_members(in, colour);
  EXPECT_EQ(colour, Colour::blue);
}

TEST(Serialization, NumbersThatAreNoEnumAreRefused) {
  for (const int number : {-1, 3, 1 << 30}) {
    OneNumber<true> in{number};
    Colour colour = Colour::green;
    EXPECT_THROW(core::serialize_members(in, colour), core::EnvironmentError) << number;
    EXPECT_EQ(colour, Colour::green);
    OneNumber<false> out;
    colour = static_cast<Colour>(number);
    EXPECT_THROW(core::serialize_members(out, colour), core::EnvironmentError) << number;
  }
}

TEST(Serialization, OptionalMembersTravelBehindAFlag) {
  OneNumber<false> out;
  std::optional<Colour> colour = Colour::green;
  core::serialize_members(out, colour);
  EXPECT_EQ(out.present, 1);
  EXPECT_EQ(out.number, 1);
  OneNumber<true> nothing{2, 0};
  core::serialize_members(nothing, colour);
  EXPECT_EQ(colour, std::nullopt);
  core::serialize_members(out, colour);
  EXPECT_EQ(out.present, 0);
  OneNumber<true> in{2, 1};
  core::serialize_members(in, colour);
  EXPECT_EQ(colour, Colour::blue);
}

TEST(Serialization, BytesThatAreNoFlagAreRefused) {
  for (const unsigned char byte : {2, 13, 255}) {
    OneNumber<true> in{2, byte};
    bool flag = true;
    EXPECT_THROW(core::serialize_members(in, flag), core::EnvironmentError) << int{byte};
    std::optional<Colour> colour = Colour::green;
    EXPECT_THROW(core::serialize_members(in, colour), core::EnvironmentError) << int{byte};
  }
}

TEST(Layouts, TellWhatIsListedWithAllVersions) {
  EXPECT_EQ(core::layout_of<Part>(), "{3:f8e2}");
  EXPECT_EQ(core::layout_of<Whole>(), "{1:s[{3:f8e2}]?e2b1}");
  EXPECT_EQ(core::layout_of<Numbers>(), "{1:b1i4u4u8f4}");
}

TEST(Completeness, OfTypesThatListAll) {
  EXPECT_EQ(test::member_count<Part>(), 2);
  EXPECT_EQ(test::member_count<Whole>(), 4);
  EXPECT_EQ(test::incomplete_types_in<Whole>(), "");
}

TEST(Completeness, AForgottenMemberShows) {
  EXPECT_THAT(test::incomplete_types_in<Forgetful>(), HasSubstr("Forgetful"));
  EXPECT_THAT(test::incomplete_types_in<Forgetful>(), HasSubstr("3 members to be sent and lists 2"));
}

TEST(Completeness, ItShowsAtDepthAndWhereAnotherIsListedTwice) {
  EXPECT_THAT(test::incomplete_types_in<Repeating>(), HasSubstr("Forgetful"));
  EXPECT_THAT(test::incomplete_types_in<Repeating>(), HasSubstr("Repeating"));
}

}  // namespace
}  // namespace serialization_test
