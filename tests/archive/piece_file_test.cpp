#include "orbweaver/archive/file/piece_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"

namespace piece_file_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::string refusal(const std::filesystem::path& path, const archive::Piece& piece) {
  try {
    (void)archive::read_piece(path, piece);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PieceFile, GivesBackWhatItGotAtOnceAndWhenSynced) {
  const auto path = test::fresh_folder("pieces") / "file";
  archive::PieceWriter writer(path);
  writer.sync();
  EXPECT_FALSE(std::filesystem::exists(path)) << "there is nothing in it";
  const std::vector<std::string> all{"one", std::string("t\0wo", 4), "", std::string(3'000'000, 'x'), "five"};
  std::vector<archive::Piece> pieces;
  for (const std::string& bytes : all) {
    pieces.push_back(writer.append(bytes));
    EXPECT_TRUE(archive::read_piece(path, pieces.back()) == bytes);
    if (pieces.size() == 2) writer.sync();
  }
  writer.sync();
  for (std::size_t n = 0; n < all.size(); ++n) EXPECT_TRUE(archive::read_piece(path, pieces[n]) == all[n]) << n;
  EXPECT_EQ(std::filesystem::file_size(path), pieces.back().offset + pieces.back().bytes);
}

TEST(PieceFile, APieceIsRefusedWhenAnyBitIsChangedOrItIsCut) {
  const auto path = test::fresh_folder("pieces_changed") / "file";
  archive::PieceWriter writer(path);
  (void)writer.append("before");
  const archive::Piece piece = writer.append("some bytes");
  (void)writer.append("behind");
  const std::string whole = bytes_of(path);
  for (std::size_t n = 0; n < 8 * whole.size(); ++n) {
    std::string changed = whole;
    changed[n / 8] = static_cast<char>(changed[n / 8] ^ (1 << (n % 8)));
    put(path, changed);
    const bool in_it = n / 8 >= piece.offset && n / 8 < piece.offset + piece.bytes;
    EXPECT_THAT(refusal(path, piece), HasSubstr(in_it ? "checksum is wrong" : "")) << "bit " << n;
    EXPECT_EQ(refusal(path, piece).empty(), !in_it) << "bit " << n;
  }
  put(path, whole.substr(0, piece.offset + piece.bytes - 1));
  EXPECT_THAT(refusal(path, piece), AllOf(HasSubstr(path.string()), HasSubstr("10 bytes from 6 on"),
                                          HasSubstr("has 15 bytes: it is torn")));
  std::filesystem::remove(path);
  EXPECT_THAT(refusal(path, piece), HasSubstr("not there"));
  std::filesystem::create_directory(path);
  EXPECT_THAT(refusal(path, piece), HasSubstr("not a regular one"));
}

TEST(PieceFile, AForgedPlaceTakesNoMemory) {
  const auto path = test::fresh_folder("pieces_forged") / "file";
  const archive::Piece piece = archive::PieceWriter(path).append("bytes");
  constexpr std::uint64_t all = ~std::uint64_t{0};
  for (const archive::Piece& forged : {archive::Piece{all, 5, piece.checksum}, archive::Piece{0, all, piece.checksum},
                                       archive::Piece{3, all - 2, piece.checksum}})
    EXPECT_THAT(refusal(path, forged), HasSubstr("torn"));
  EXPECT_EQ(refusal(path, piece), "");
}

TEST(PieceFile, WritesIntoNoFileThatIsThereAlready) {
  const auto path = test::fresh_folder("pieces_there") / "file";
  put(path, "another's");
  archive::PieceWriter writer(path);
  EXPECT_THROW((void)writer.append("bytes"), core::EnvironmentError);
  EXPECT_EQ(bytes_of(path), "another's");
}

}  // namespace
}  // namespace piece_file_test
