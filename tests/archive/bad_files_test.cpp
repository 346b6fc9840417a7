#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <random>

#include <fmt/format.h>
#include <sys/stat.h>

#include "archive/sample.hpp"
#include "file/h5_handle.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/error.hpp"

namespace bad_files_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const core::InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "the file was taken for good";
  return "";
}

std::string atlas_refusal(const std::filesystem::path& path) {
  return refusal([&] { const Archive atlas(path); });
}

class BadFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = test::fresh_folder(::testing::UnitTest::GetInstance()->current_test_info()->name());
    test::write_sample_atlas(folder, test::sample_header(), test::sample_records(test::sample_header()));
    atlas = folder / "atlas.h5";
    segment = folder / "segment.h5";
  }

  // The refusal of an atlas that `change` has altered.
  std::string altered(const std::function<void(hid_t)>& change) const { return atlas_refusal(alter(atlas, change)); }

  [[nodiscard]] std::filesystem::path alter(const std::filesystem::path& source,
                                            const std::function<void(hid_t)>& change) const {
    const std::filesystem::path copy = folder / "altered.h5";
    std::filesystem::copy_file(source, copy, std::filesystem::copy_options::overwrite_existing);
    quiet_h5();
    H5Handle file(check_h5(H5Fopen(copy.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "H5Fopen"), H5Fclose);
    change(file.get());
    file.close("H5Fclose");
    return copy;
  }

  std::filesystem::path folder;
  std::filesystem::path atlas;
  std::filesystem::path segment;
};

void write_version(hid_t file, std::int64_t version) {
  const H5Handle attribute(check_h5(H5Aopen(file, "format_version", H5P_DEFAULT), "H5Aopen"), H5Aclose);
  check_h5(H5Awrite(attribute.get(), H5T_NATIVE_INT64, &version), "H5Awrite");
}

void replace_dataset(hid_t file, const char* name, hid_t type, const std::vector<hsize_t>& extents) {
  check_h5(H5Ldelete(file, name, H5P_DEFAULT), "H5Ldelete");
  const H5Handle space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose);
  const H5Handle dataset(
      check_h5(H5Dcreate2(file, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), name), H5Dclose);
}

// Every column of the table claims `rows` rows, which take no room in the file until they are written.
void claim_rows(hid_t file, const std::string& table, hsize_t rows) {
  const H5Handle group(check_h5(H5Gopen2(file, table.c_str(), H5P_DEFAULT), table), H5Gclose);
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check_h5(H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names), "H5Literate");
  for (const std::string& name : names) {
    const H5Handle column(check_h5(H5Dopen2(group.get(), name.c_str(), H5P_DEFAULT), name), H5Dclose);
    const H5Handle type(H5Dget_type(column.get()), H5Tclose);
    const H5Handle space(H5Dget_space(column.get()), H5Sclose);
    std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
    H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
    extents[0] = rows;
    replace_dataset(group.get(), name.c_str(), type.get(), extents);
  }
}

void set_integer(hid_t file, const char* name, hsize_t row, std::int64_t value) {
  const H5Handle dataset(check_h5(H5Dopen2(file, name, H5P_DEFAULT), name), H5Dclose);
  const H5Handle place(H5Dget_space(dataset.get()), H5Sclose);
  const hsize_t one = 1;
  H5Sselect_hyperslab(place.get(), H5S_SELECT_SET, &row, nullptr, &one, nullptr);
  const H5Handle memory(H5Screate_simple(1, &one, nullptr), H5Sclose);
  check_h5(H5Dwrite(dataset.get(), H5T_NATIVE_INT64, memory.get(), place.get(), H5P_DEFAULT, &value), name);
}

void delete_attributes(hid_t file, const std::vector<const char*>& names) {
  for (const char* name : names) check_h5(H5Adelete(file, name), name);
}

// An archive from before there was a format_minor.
TEST_F(BadFiles, OlderFilesHaveNoScales) {
  {
    const Archive older(alter(atlas, [](hid_t file) {
      delete_attributes(
          file, {"format_minor", "system", "effects", "parameter_names", "parameter_values", "scale_names", "scales"});
    }));
    EXPECT_TRUE(older.header().system.empty());
    EXPECT_TRUE(older.header().scales.empty());
    EXPECT_GT(older.orbits().rows(), 0U);
  }
  EXPECT_THAT(altered([](hid_t file) { delete_attributes(file, {"scales"}); }),
              HasSubstr("lacks the attribute 'scales'"));
}

TEST_F(BadFiles, NoMoreIsReadThanTheFileHolds) {
  constexpr hsize_t forged = hsize_t{1} << 28;
  for (const std::string table : {"families", "orbits", "crossings", "sections", "loci", "equilibria", "findings"})
    EXPECT_THAT(altered([&](hid_t file) { claim_rows(file, table, forged); }),
                AllOf(HasSubstr("altered.h5' has a dataset /" + table), HasSubstr("more than the file's")))
        << table;
  EXPECT_THAT(altered([](hid_t file) { replace_dataset(file, "modes", H5T_NATIVE_DOUBLE, {forged}); }),
              HasSubstr("has a dataset /modes of shape (268435456) with values of 8 bytes, more than the file's"));
  EXPECT_THAT(altered([](hid_t file) {
                const H5Handle wide(H5Tcopy(H5T_C_S1), H5Tclose);
                check_h5(H5Tset_size(wide.get(), forged), "H5Tset_size");
                claim_rows(file, "findings", 1);
                replace_dataset(file, "findings/text", wide.get(), {1});
              }),
              HasSubstr("has a dataset /findings/text of shape (1) with values of 268435456 bytes"));
}

TEST_F(BadFiles, AFolderStandsForItsAtlas) {
  EXPECT_EQ(Archive(folder).path(), folder / "atlas.h5");
  EXPECT_EQ(Archive(folder / "").path(), folder / "atlas.h5");
  std::filesystem::create_directories(folder / "other" / "segments");
  EXPECT_THAT(atlas_refusal(folder / "other"),
              AllOf(HasSubstr("other' is the folder of a survey that has not come to its end"),
                    HasSubstr("other --resume`"), HasSubstr("`orbweaver consolidate")));
  std::filesystem::create_directory(folder / "empty");
  EXPECT_THAT(atlas_refusal(folder / "empty"), HasSubstr("empty' is a folder; an Orbweaver atlas was expected"));
}

TEST_F(BadFiles, AbsentAndForeignFilesAreNamed) {
  EXPECT_THAT(atlas_refusal(folder / "none.h5"), AllOf(HasSubstr("none.h5' does not exist"), HasSubstr("survey")));
  std::ofstream(folder / "text.h5") << "name: double-pendulum\n";
  EXPECT_THAT(atlas_refusal(folder / "text.h5"), HasSubstr("is not an HDF5 file"));
  std::ofstream(folder / "nothing.h5").close();
  EXPECT_THAT(atlas_refusal(folder / "nothing.h5"), HasSubstr("is not an HDF5 file"));
  EXPECT_THAT(atlas_refusal(segment), HasSubstr("'orbweaver-segment'"));
  EXPECT_THAT(refusal([&] { inspect_segment(atlas); }), HasSubstr("'orbweaver-atlas'"));
  { const H5Handle other(H5Fcreate((folder / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose); }
  EXPECT_THAT(atlas_refusal(folder / "other.h5"), HasSubstr("something else"));
}

TEST_F(BadFiles, AFileCutShortAnywhereIsRefused) {
  std::mt19937 generator(1);
  for (const auto& whole : {atlas, segment}) {
    const auto size = std::filesystem::file_size(whole);
    std::vector<std::uintmax_t> lengths{1, 7, 8, 48, 512, size / 2, size - 1};
    for (int i = 0; i < 40; ++i) lengths.push_back(generator() % size);
    for (const std::uintmax_t length : lengths) {
      SCOPED_TRACE(fmt::format("{} cut to {} of {} bytes", whole.string(), length, size));
      const std::filesystem::path cut = folder / "cut.h5";
      std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
      std::filesystem::resize_file(cut, length);
      const std::string text = whole == atlas ? atlas_refusal(cut) : refusal([&] { inspect_segment(cut); });
      EXPECT_THAT(text, AllOf(HasSubstr("cut.h5'"), HasSubstr("cut short")));
    }
  }
}

TEST_F(BadFiles, OtherFormatsAndVersionsAreNamed) {
  EXPECT_THAT(altered([](hid_t file) { write_version(file, 2); }),
              AllOf(HasSubstr("format_version 2"), HasSubstr("versions up to 1"), HasSubstr("newer")));
  EXPECT_THAT(altered([](hid_t file) { write_version(file, 0); }), HasSubstr("format_version 0"));
  EXPECT_THAT(altered([](hid_t file) { H5Adelete(file, "scene"); }), HasSubstr("lacks the attribute 'scene'"));
  EXPECT_THAT(altered([](hid_t file) { H5Adelete(file, "format"); }), HasSubstr("no attribute 'format'"));
  EXPECT_THAT(altered([](hid_t file) {
                H5Adelete(file, "format_version");
                H5Arename(file, "scene", "format_version");
              }),
              HasSubstr("not an integer"));
}

TEST_F(BadFiles, EveryDatasetIsMissed) {
  for (const auto& [name, bytes] : test::dataset_bytes(atlas)) {
    SCOPED_TRACE(name);
    const auto remove = [dataset = name](hid_t file) {
      check_h5(H5Ldelete(file, dataset.c_str(), H5P_DEFAULT), dataset);
    };
    EXPECT_THAT(altered(remove), HasSubstr("lacks the dataset /" + name));
  }
  EXPECT_THAT(altered([](hid_t file) { H5Ldelete(file, "crossings", H5P_DEFAULT); }),
              HasSubstr("lacks the dataset /crossings/family"));
}

// As files of format_minor 0.
TEST_F(BadFiles, AFileWithoutFindingsIsRead) {
  const std::filesystem::path old = alter(atlas, [](hid_t file) {
    check_h5(H5Ldelete(file, "findings", H5P_DEFAULT), "findings");
    check_h5(H5Adelete(file, "format_minor"), "format_minor");
  });
  EXPECT_EQ(Archive(old).findings().rows(), 0U);
  EXPECT_EQ(Archive(old).orbits().rows(), Archive(atlas).orbits().rows());
}

TEST_F(BadFiles, FindingsThatPointNowhereAreNamed) {
  const std::filesystem::path path = folder / "pointing.h5";
  const auto witness = [](const std::filesystem::path&) {
    std::vector<FindingRecord> findings(1);
    findings[0].family = 99;
    return std::optional(findings);
  };
  consolidate(MPI_COMM_SELF, {segment}, path, test::sample_header(),
              test::tables_of(test::sample_records(test::sample_header())), {}, witness);
  EXPECT_THAT(atlas_refusal(path), HasSubstr("/findings/family = 99"));
}

/// Another file may be a pipe, which is waited for, or one of this machine that is nobody's business.
TEST_F(BadFiles, ValuesInOtherFilesAreRefused) {
  const std::filesystem::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string name = "orbits/period";
  const auto creation_with = [](const std::function<void(hid_t, hid_t)>& set, hid_t space) {
    H5Handle creation(check_h5(H5Pcreate(H5P_DATASET_CREATE), "H5Pcreate"), H5Pclose);
    set(creation.get(), space);
    return creation;
  };
  const auto created = [&](const std::function<void(hid_t, hid_t)>& set) {
    return altered([&](hid_t file) {
      const H5Handle old(check_h5(H5Dopen2(file, name.c_str(), H5P_DEFAULT), name), H5Dclose);
      const H5Handle space(check_h5(H5Dget_space(old.get()), name), H5Sclose);
      const H5Handle creation = creation_with(set, space.get());
      check_h5(H5Ldelete(file, name.c_str(), H5P_DEFAULT), "H5Ldelete");
      const H5Handle dataset(check_h5(H5Dcreate2(file, name.c_str(), H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT,
                                                 creation.get(), H5P_DEFAULT),
                                      name),
                             H5Dclose);
    });
  };
  const auto refused =
      HasSubstr("lacks the dataset /orbits/period, or it is damaged, compressed or lies in another file");
  EXPECT_THAT(created([&](hid_t creation, hid_t) {
                check_h5(H5Pset_external(creation, pipe.c_str(), 0, H5F_UNLIMITED), "H5Pset_external");
              }),
              refused);
  EXPECT_THAT(created([&](hid_t creation, hid_t space) {
                check_h5(H5Pset_virtual(creation, space, pipe.c_str(), "/x", space), "H5Pset_virtual");
              }),
              refused);
  for (const std::string& link : {name, std::string("orbits")})
    EXPECT_THAT(altered([&](hid_t file) {
                  check_h5(H5Ldelete(file, link.c_str(), H5P_DEFAULT), "H5Ldelete");
                  check_h5(H5Lcreate_external(pipe.c_str(), "/x", file, link.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                           "H5Lcreate_external");
                }),
                HasSubstr("lies in another file"))
        << link;
}

TEST_F(BadFiles, WrongLengthsShapesAndTypesAreNamed) {
  EXPECT_THAT(altered([](hid_t file) { replace_dataset(file, "orbits/energy", H5T_IEEE_F64LE, {28}); }),
              AllOf(HasSubstr("/orbits/energy of shape (28)"), HasSubstr("(29) was expected")));
  EXPECT_THAT(altered([](hid_t file) {
                replace_dataset(file, "orbits/state", H5T_IEEE_F64LE, {29, 3});
              }),
              HasSubstr("/orbits/state of shape (29 x 3)"));
  EXPECT_THAT(altered([](hid_t file) { replace_dataset(file, "orbits/stability", H5T_IEEE_F64LE, {29}); }),
              HasSubstr("/orbits/stability of shape (29)"));
  EXPECT_THAT(altered([](hid_t file) { replace_dataset(file, "orbits/step", H5T_IEEE_F64LE, {29}); }),
              AllOf(HasSubstr("/orbits/step"), HasSubstr("integers were expected")));
  EXPECT_THAT(altered([](hid_t file) { replace_dataset(file, "families/name", H5T_STD_I64LE, {5}); }),
              HasSubstr("fixed-length strings were expected"));
  EXPECT_THAT(altered([](hid_t file) {
                replace_dataset(file, "modes", H5T_IEEE_F64LE, {4, 5});
              }),
              HasSubstr("/modes of shape (4 x 5)"));
  EXPECT_THAT(altered([](hid_t file) { replace_dataset(file, "modes", H5T_IEEE_F64LE, {10}); }),
              HasSubstr("beyond the 10 values"));
}

TEST_F(BadFiles, IndicesOutsideTheirTablesAreNamed) {
  const auto expect_bad = [&](const char* name, hsize_t row, std::int64_t value, const std::string& text) {
    SCOPED_TRACE(fmt::format("{} = {}", name, value));
    EXPECT_THAT(altered([&](hid_t file) { set_integer(file, name, row, value); }),
                AllOf(HasSubstr(text), HasSubstr(fmt::format("{}", value)), HasSubstr(fmt::format("row {}", row))));
  };
  expect_bad("families/parent", 1, 5, "/families/parent");
  expect_bad("families/crossing", 1, 3, "/families/crossing");
  expect_bad("families/end_family", 0, -2, "/families/end_family");
  expect_bad("families/end_crossing", 0, 99, "/families/end_crossing");
  expect_bad("families/first_orbit", 1, 11, "/families/first_orbit");
  expect_bad("families/orbit_count", 4, 6, "/families/orbit_count");
  expect_bad("orbits/family", 3, 5, "/orbits/family");
  expect_bad("orbits/family", 3, 1, "/orbits/family");
  expect_bad("orbits/modes_begin", 28, -1, "/orbits/modes_begin");
  expect_bad("orbits/modes_count", 2, 7, "/orbits/modes_count");
  expect_bad("orbits/time_map_count", 28, std::int64_t{1} << 62, "/orbits/time_map_count");
  expect_bad("orbits/cutoff", 2, std::int64_t{1} << 62, "cutoff 4611686018427387904");
  expect_bad("sections/orbit", 0, 29, "/sections/orbit");
  expect_bad("crossings/family", 2, -1, "/crossings/family");
}

TEST_F(BadFiles, ATornSegmentIsToldFromAWholeOne) {
  EXPECT_NO_THROW(inspect_segment(segment));
  const auto bad = [&](const char* name, hsize_t row, std::int64_t value) {
    return refusal([&] { inspect_segment(alter(segment, [&](hid_t file) { set_integer(file, name, row, value); })); });
  };
  EXPECT_THAT(bad("orbits/modes_begin", 4, 0),
              AllOf(HasSubstr("modes_begin = 0"), HasSubstr("has to come from a copy")));
  EXPECT_THAT(bad("orbits/cutoff", 4, 0), HasSubstr("cutoff 0"));
  EXPECT_THAT(bad("orbits/cutoff", 4, std::int64_t{1} << 62), HasSubstr("cutoff 4611686018427387904"));
  EXPECT_THAT(bad("orbits/time_map_count", 28, 1000), HasSubstr("add up to more: 1000 in row 28"));
  EXPECT_THAT(bad("orbits/time_map_count", 28, std::int64_t{1} << 62), HasSubstr("add up to more"));
}

}  // namespace
}  // namespace bad_files_test
