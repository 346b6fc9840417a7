#include "orbweaver/archive/file/text_table.hpp"

#include <gmock/gmock.h>

#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "archive/sample.hpp"
#include "file/h5_handle.hpp"
#include "orbweaver/core/error.hpp"

namespace text_table_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::HasSubstr;

class TextTables : public ::testing::Test {
 protected:
  void SetUp() override {
    path = test::fresh_folder(::testing::UnitTest::GetInstance()->current_test_info()->name()) / "table.h5";
    write_text_table(path, table);
  }

  void alter(const std::function<void(hid_t)>& change) const {
    quiet_h5();
    H5Handle file(check_h5(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "H5Fopen"), H5Fclose);
    change(file.get());
    file.close("H5Fclose");
  }

  const TextTable table{"texts", 1, "rows", {"first"}, {{"a", "b"}}};
  std::filesystem::path path;
};

// HDF5 1.10 keeps the identifier of a file that it could not close and has freed; when it ends it looks at it again.
TEST_F(TextTables, HDF5EndsInPeaceAfterAFileThatCannotBeWritten) {
  const auto close_on_a_full_disk = [this] {
    quiet_h5();
    std::signal(SIGXFSZ, SIG_IGN);
    H5Handle file(check_h5(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), "H5Fcreate"),
                  close_written_file);
    const rlimit nothing{0, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &nothing);
    std::string said;
    try {
      file.close("cannot close it");
    } catch (const core::EnvironmentError& error) {
      said = error.what();
    }
    H5close();
    std::_Exit(said.find("File too large") == std::string::npos ? 1 : 0);
  };
  EXPECT_EXIT(close_on_a_full_disk(), ::testing::ExitedWithCode(0), "");
}

/// An attribute that holds many values where its reader has room for one.
void make_attribute_long(hid_t file, const char* name, hid_t type) {
  constexpr hsize_t many = 5000;
  check_h5(H5Adelete(file, name), name);
  const H5Handle space(check_h5(H5Screate_simple(1, &many, nullptr), name), H5Sclose);
  const H5Handle attribute(check_h5(H5Acreate2(file, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT), name),
                           H5Aclose);
}

TEST_F(TextTables, AreReadAsTheyWereWritten) { EXPECT_EQ(read_text_table(path, table).values, table.values); }

TEST_F(TextTables, AFormatOfManyTextsIsNone) {
  const H5Handle type(check_h5(H5Tcopy(H5T_C_S1), "H5Tcopy"), H5Tclose);
  check_h5(H5Tset_size(type.get(), 5), "H5Tset_size");
  alter([&](hid_t file) { make_attribute_long(file, "format", type.get()); });
  EXPECT_FALSE(format_of(path).has_value());
}

TEST_F(TextTables, AVersionOfManyNumbersIsRefused) {
  alter([](hid_t file) { make_attribute_long(file, "format_version", H5T_NATIVE_INT64); });
  EXPECT_THAT([&] { static_cast<void>(read_text_table(path, table)); },
              ThrowsMessage<core::InputError>(HasSubstr("format_version that is not one number")));
}

TEST_F(TextTables, RowsThatAreOnlyClaimedTakeNoMemory) {
  alter([](hid_t file) {
    constexpr hsize_t claimed = hsize_t{1} << 40;
    constexpr hsize_t chunk = 1024;
    check_h5(H5Ldelete(file, "rows/first", H5P_DEFAULT), "H5Ldelete");
    const H5Handle space(check_h5(H5Screate_simple(1, &claimed, nullptr), "H5Screate_simple"), H5Sclose);
    const H5Handle creation(check_h5(H5Pcreate(H5P_DATASET_CREATE), "H5Pcreate"), H5Pclose);
    check_h5(H5Pset_chunk(creation.get(), 1, &chunk), "H5Pset_chunk");
    const H5Handle dataset(
        check_h5(H5Dcreate2(file, "rows/first", H5T_C_S1, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                 "H5Dcreate2"),
        H5Dclose);
  });
  EXPECT_THAT([&] { static_cast<void>(read_text_table(path, table)); },
              ThrowsMessage<core::InputError>(HasSubstr("claims 1099511627776 rows")));
}

// HDF5 1.10 reads on behind a chunk that unpacks to fewer bytes than it should: a crash.
TEST_F(TextTables, ACompressedColumnIsRefused) {
  alter([](hid_t file) {
    constexpr hsize_t rows = 2;
    check_h5(H5Ldelete(file, "rows/first", H5P_DEFAULT), "H5Ldelete");
    const H5Handle space(check_h5(H5Screate_simple(1, &rows, nullptr), "H5Screate_simple"), H5Sclose);
    const H5Handle creation(check_h5(H5Pcreate(H5P_DATASET_CREATE), "H5Pcreate"), H5Pclose);
    check_h5(H5Pset_chunk(creation.get(), 1, &rows), "H5Pset_chunk");
    check_h5(H5Pset_deflate(creation.get(), 1), "H5Pset_deflate");
    const H5Handle dataset(
        check_h5(H5Dcreate2(file, "rows/first", H5T_C_S1, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                 "H5Dcreate2"),
        H5Dclose);
    check_h5(H5Dwrite(dataset.get(), H5T_C_S1, H5S_ALL, H5S_ALL, H5P_DEFAULT, "ab"), "H5Dwrite");
  });
  EXPECT_THAT([&] { static_cast<void>(read_text_table(path, table)); },
              ThrowsMessage<core::InputError>(HasSubstr("/rows/first, or it is damaged or compressed")));
}

// HDF5 1.10 reads on behind the values: a crash.
TEST_F(TextTables, ACompactColumnThatHoldsFewerBytesThanItsRowsIsRefused) {
  constexpr hsize_t rows = 2, width = 3001;
  alter([&](hid_t file) {
    check_h5(H5Ldelete(file, "rows/first", H5P_DEFAULT), "H5Ldelete");
    const H5Handle type(check_h5(H5Tcopy(H5T_C_S1), "H5Tcopy"), H5Tclose);
    check_h5(H5Tset_size(type.get(), width), "H5Tset_size");
    const H5Handle space(check_h5(H5Screate_simple(1, &rows, nullptr), "H5Screate_simple"), H5Sclose);
    const H5Handle creation(check_h5(H5Pcreate(H5P_DATASET_CREATE), "H5Pcreate"), H5Pclose);
    check_h5(H5Pset_layout(creation.get(), H5D_COMPACT), "H5Pset_layout");
    const H5Handle dataset(
        check_h5(H5Dcreate2(file, "rows/first", type.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                 "H5Dcreate2"),
        H5Dclose);
    check_h5(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, std::string(rows * width, 'a').data()),
             "H5Dwrite");
  });
  std::string bytes = (std::ostringstream() << std::ifstream(path, std::ios::binary).rdbuf()).str();
  const std::string whole{'\x03', '\0', static_cast<char>(rows * width & 0xff), static_cast<char>(rows * width >> 8)};
  const std::size_t layout = bytes.find(whole);  // version 3, compact, the size of what follows
  ASSERT_NE(layout, std::string::npos);
  ASSERT_EQ(bytes.find(whole, layout + 1), std::string::npos);
  bytes[layout + 2] = bytes[layout + 3] = '\0';
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_THAT([&] { static_cast<void>(read_text_table(path, table)); },
              ThrowsMessage<core::InputError>(HasSubstr("lacks the column /rows/first, or it is damaged")));
}

}  // namespace
}  // namespace text_table_test
