// The text of a model: it comes back as it was given, and what was changed of it is found.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "file/h5_handle.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/file_hash.hpp"

namespace model_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::filesystem::path written(const std::string& folder, const std::string& model) {
  Header header = test::sample_header();
  header.model = model;
  return test::write_sample_atlas(test::fresh_folder("model_" + folder), header, test::sample_records(header));
}

/// Makes the bytes `from`, which stand there once, `to`, of the same length.
void change(const std::filesystem::path& path, const std::string& from, const std::string& to) {
  std::ostringstream read;
  read << std::ifstream(path, std::ios::binary).rdbuf();
  std::string bytes = read.str();
  const std::size_t place = bytes.find(from);
  ASSERT_NE(place, std::string::npos);
  ASSERT_EQ(bytes.find(from, place + 1), std::string::npos);
  std::ofstream(path, std::ios::binary) << bytes.replace(place, to.size(), to);
}

const std::string text = "# Größe\nequations:\n  x': y\n  y': -x\n";

TEST(ModelText, ComesBackAsItWasGiven) {
  EXPECT_EQ(Archive(written("whole", text)).header().model, text);
  EXPECT_EQ(Archive(written("none", "")).header().model, "");
  const std::string longest(longest_model, 'x');
  EXPECT_EQ(Archive(written("longest", longest)).header().model, longest);
  EXPECT_THROW(written("longer", longest + "x"), core::MisuseError);
}

TEST(ModelText, IsFoundChanged) {
  const std::filesystem::path atlas = written("changed", text);
  change(atlas, "y': -x", "y': +x");
  EXPECT_THAT([&] { Archive{atlas}; }, ThrowsMessage<core::InputError>(HasSubstr("row 0 of /model")));
  const Archive listed(atlas, ChangedRows::listed);
  ASSERT_EQ(listed.changed_rows().size(), 1U);
  EXPECT_EQ(listed.changed_rows().front().table, "model");
}

TEST(ModelText, GivesTheHashOnTheRoot) {
  const std::filesystem::path atlas = written("hash", text);
  {
    const H5Handle file(check_h5(H5Fopen(atlas.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "H5Fopen"), H5Fclose);
    const H5Handle hash(check_h5(H5Aopen(file.get(), "model_hash", H5P_DEFAULT), "model_hash"), H5Aclose);
    const H5Handle type(check_h5(H5Aget_type(hash.get()), "type"), H5Tclose);
    std::string stored(40, '\0');
    check_h5(H5Aread(hash.get(), type.get(), stored.data()), "read");
    EXPECT_EQ(stored, core::text_hash(text));
    EXPECT_EQ(stored.size(), H5Tget_size(type.get()));
    check_h5(H5Awrite(hash.get(), type.get(), core::text_hash("another").c_str()), "write");
  }
  EXPECT_THAT([&] { Archive{atlas}; }, ThrowsMessage<core::InputError>(HasSubstr("does not give the hash")));
}

}  // namespace
}  // namespace model_test
