#include "orbweaver/archive/file/sealed_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"

namespace sealed_file_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;

constexpr archive::Seal seal{"ORBWTST\x1a", 3};

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::string refusal(const std::filesystem::path& path, const archive::Seal& as = seal) {
  try {
    (void)archive::read_sealed(path, as);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SealedFile, GivesBackWhatItGot) {
  const auto folder = test::fresh_folder("sealed");
  for (const std::string& bytes : {std::string(), std::string("a\0b", 3), std::string(3'000'000, 'x')}) {
    archive::write_sealed(folder / "file", seal, bytes);
    EXPECT_TRUE(archive::read_sealed(folder / "file", seal) == bytes);
    EXPECT_FALSE(std::filesystem::exists(folder / "file.part"));
  }
}

TEST(SealedFile, IsRefusedWhenCutAnywhereOrLengthened) {
  const auto folder = test::fresh_folder("sealed_cut");
  archive::write_sealed(folder / "file", seal, "some bytes");
  const std::string whole = bytes_of(folder / "file");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    put(folder / "file", whole.substr(0, length));
    EXPECT_THAT(refusal(folder / "file"), HasSubstr("torn")) << length;
  }
  put(folder / "file", whole + "x");
  EXPECT_THAT(refusal(folder / "file"), HasSubstr("torn"));
}

TEST(SealedFile, IsRefusedWhenAnyBitIsChanged) {
  const auto folder = test::fresh_folder("sealed_changed");
  archive::write_sealed(folder / "file", seal, "some bytes");
  const std::string whole = bytes_of(folder / "file");
  for (std::size_t n = 0; n < 8 * whole.size(); ++n) {
    std::string changed = whole;
    changed[n / 8] = static_cast<char>(changed[n / 8] ^ (1 << (n % 8)));
    put(folder / "file", changed);
    EXPECT_NE(refusal(folder / "file"), "") << "bit " << n;
  }
}

TEST(SealedFile, ReadsItsOwnVersionAlone) {
  const auto folder = test::fresh_folder("sealed_version");
  archive::write_sealed(folder / "file", {seal.mark, 4}, "newer");
  EXPECT_THAT(refusal(folder / "file"), HasSubstr("its version is 4, and this Orbweaver reads version 3"));
  archive::write_sealed(folder / "file", {seal.mark, 2}, "older");
  EXPECT_THAT(refusal(folder / "file"), HasSubstr("its version is 2, and this Orbweaver reads version 3"));
  EXPECT_THAT(refusal(folder / "file", {"ORBWXYZ\x1a", 3}), HasSubstr("another program's"));
  EXPECT_THAT(refusal(folder / "absent"), HasSubstr("not there"));
}

TEST(SealedFile, KeepsTheOneBefore) {
  const auto folder = test::fresh_folder("sealed_previous");
  archive::write_sealed_keeping(folder / "file", folder / "previous", seal, "1");
  EXPECT_FALSE(std::filesystem::exists(folder / "previous"));
  for (const char* bytes : {"2", "3"}) {
    const std::string before = archive::read_sealed(folder / "file", seal);
    archive::write_sealed_keeping(folder / "file", folder / "previous", seal, bytes);
    EXPECT_EQ(archive::read_sealed(folder / "file", seal), bytes);
    EXPECT_EQ(archive::read_sealed(folder / "previous", seal), before);
  }
}

TEST(SealedFile, SaysWhereItCannotBeWritten) {
  const auto folder = test::fresh_folder("sealed_nowhere");
  try {
    archive::write_sealed(folder / "absent" / "file", seal, "bytes");
    FAIL() << "written into a folder that is not there";
  } catch (const core::EnvironmentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent/file.part"));
  }
}

}  // namespace
}  // namespace sealed_file_test
