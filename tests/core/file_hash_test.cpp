#include "orbweaver/core/file_hash.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core::file_hash_test {
namespace {

// The examples of FIPS 180-1, appendices A and B.
TEST(FileHash, IsSha1OfTheContentsInTheirOrder) {
  std::ofstream("abc") << "abc";
  std::ofstream("first") << "abcdbcdecdefdefgefghfghighij";
  std::ofstream("second") << "hijkijkljklmklmnlmnomnopnopq";
  EXPECT_EQ(file_hash({"abc"}), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(file_hash({"first", "second"}), "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  EXPECT_THROW((void)file_hash({"nowhere"}), InputError);
}

}  // namespace
}  // namespace orbweaver::core::file_hash_test
