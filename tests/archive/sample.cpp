#include "archive/sample.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include <fmt/format.h>
#include <unistd.h>

#include "file/h5_handle.hpp"
#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"

namespace orbweaver::test {

namespace {

using namespace archive;

// Distinct, exactly representable, of both signs.
std::vector<double> numbers(std::size_t count, double first) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = (i % 2 == 0 ? 1 : -1) * (first + static_cast<double>(i) / 64);
  return values;
}

OrbitRecord sample_orbit(const Header& header, const std::string& key, int step, double id) {
  OrbitRecord orbit;
  orbit.family_key = key;
  orbit.step = step;
  orbit.arclength = step / 4.0;
  orbit.period = 2 + id / 8;
  orbit.energy = -3 + id / 16;
  orbit.action = id / 32;
  orbit.cutoff = static_cast<int>(id) % 7;
  orbit.loss_rms = 1e-11;
  orbit.stability = numbers(stability_width(header), id);
  if (step % 2 == 0) orbit.fundamental_stability = numbers(stability_width(header), id + 0.5);
  orbit.state = numbers(header.state_names.size(), 100 * id);
  orbit.tail = id / 1024;
  orbit.modes = numbers((2 * static_cast<std::size_t>(orbit.cutoff) + 1) * header.state_names.size(), 1000 * id);
  if (step % 3 == 0) orbit.time_map = numbers(static_cast<std::size_t>(3 + orbit.cutoff), -1000 * id);
  orbit.winding = {0};
  return orbit;
}

void add_orbits(Records& records, const Header& header, const std::string& key, int first, int last) {
  for (int step = first; step <= last; ++step) {
    const auto id = static_cast<double>(records.orbits.size());
    records.orbits.push_back(sample_orbit(header, key, step, id));
    records.sections.push_back({key, step, 1.5, numbers(2, id)});
    if (step % 2 == 0) records.sections.push_back({key, step, 0.25, numbers(2, id + 0.5)});
    if (step % 4 == 0) records.sections.push_back({key, step, 0.25, numbers(2, id + 0.75)});
  }
}

FamilyRecord family(std::string key, std::string name, std::string parent, int crossing) {
  FamilyRecord record;
  record.key = std::move(key);
  record.name = std::move(name);
  record.parent_key = std::move(parent);
  record.crossing = crossing;
  record.isotropy = "S@1/2 R@0";
  record.end_reason = "the period reached the scene's limit";
  return record;
}

CrossingRecord crossing(std::string key, double arclength, CrossingKind kind) {
  CrossingRecord record;
  record.family_key = std::move(key);
  record.arclength = arclength;
  record.period = 4 + arclength;
  record.kind = kind;
  record.state = {arclength, -1};
  record.kernel_dimension = 2;
  return record;
}

std::string raw_bytes(hid_t file, const std::string& name) {
  const H5Handle dataset(check_h5(H5Dopen2(file, name.c_str(), H5P_DEFAULT), name), H5Dclose);
  const H5Handle type(check_h5(H5Dget_type(dataset.get()), name), H5Tclose);
  const H5Handle space(check_h5(H5Dget_space(dataset.get()), name), H5Sclose);
  std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  const auto values = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get()));
  std::string bytes(values * H5Tget_size(type.get()), '\0');
  if (values > 0) check_h5(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), name);
  std::string head =
      fmt::format("class {} size {}", static_cast<int>(H5Tget_class(type.get())), H5Tget_size(type.get()));
  for (const hsize_t extent : extents) head += fmt::format(" x {}", extent);
  return head + ':' + bytes;
}

herr_t collect_dataset(hid_t, const char* name, const H5O_info_t* info, void* data) {
  if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(data)->emplace_back(name);
  return 0;
}

}  // namespace

Header sample_header(int pairs, bool symplectic) {
  Header header;
  header.orbweaver_version = "0.1.0";
  header.scene = "name: sämple\nsystem: {name: made_up}\n";
  header.state_names = {"θ1", "w1"};
  header.winding_names = {"n1"};
  header.winding_coordinates = {0};
  header.pairs = pairs;
  header.symplectic = symplectic;
  header.system = "made_up";
  header.effects = {"friction"};
  header.parameter_names = {"m", "g"};
  header.parameter_values = {0.1, 9.81};
  header.scale_names = {"time", "θ1", "w1", "energy"};
  header.scales = {0.25, 1.0, 4.0, 16.0};
  return header;
}

Records sample_records(const Header& header) {
  Records records;
  records.families = {family("0003.0001", "Ästhetik \"B\", 1", "0003", 1), family("0003", "Out-Phase", "", -1),
                      family("0001", "In-Phase", "", -1), family("0002", "Up-Down", "", -1),
                      family("0001.0002", "ID1", "0001", 0)};
  records.families[0].multiplicity = 2;
  records.families[0].end_family_key = "0001.0002";
  records.families[0].end_crossing = 2;
  records.families[3].end_reason = "no first orbit could be found – the Newton iteration stalled";
  records.crossings = {crossing("0001", 2.5, CrossingKind::period_doubling),
                       crossing("0003", 1.5, CrossingKind::branch_point),
                       crossing("0001", 0.5, CrossingKind::fold_energy)};
  add_orbits(records, header, "0003", -4, 4);
  add_orbits(records, header, "0001", 0, 11);
  add_orbits(records, header, "0003.0001", 1, 5);
  add_orbits(records, header, "0001.0002", 0, 2);
  return records;
}

Records tables_of(const Records& records) {
  Records tables;
  tables.families = records.families;
  tables.crossings = records.crossings;
  tables.loci = records.loci;
  tables.equilibria = records.equilibria;
  tables.left_out_keys = records.left_out_keys;
  tables.voided = records.voided;
  tables.earlier_scenes = records.earlier_scenes;
  return tables;
}

Records rows_of(const Records& records) {
  Records rows;
  rows.orbits = records.orbits;
  rows.sections = records.sections;
  return rows;
}

Records deal(const Records& records, int part, int parts, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<std::size_t> order(records.orbits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), generator);
  Records mine;
  for (const std::size_t i : order) {
    const bool is_mine = static_cast<int>(generator() % static_cast<unsigned>(parts)) == part;
    if (!is_mine) continue;
    const OrbitRecord& orbit = records.orbits[i];
    mine.orbits.push_back(orbit);
    for (const SectionRecord& section : records.sections)
      if (section.family_key == orbit.family_key && section.step == orbit.step) mine.sections.push_back(section);
  }
  return mine;
}

std::filesystem::path write_sample_atlas(const std::filesystem::path& folder, const Header& header,
                                         const Records& records) {
  write_segment(MPI_COMM_SELF, folder / "segment.h5", header, rows_of(records));
  consolidate(MPI_COMM_SELF, {folder / "segment.h5"}, folder / "atlas.h5", header, tables_of(records));
  return folder / "atlas.h5";
}

std::map<std::string, std::string> dataset_bytes(const std::filesystem::path& path) {
  const H5Handle file(check_h5(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), path.string()), H5Fclose);
  std::vector<std::string> names;
  check_h5(H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, collect_dataset, &names), "H5Ovisit");
  std::map<std::string, std::string> bytes;
  for (const std::string& name : names) bytes[name] = raw_bytes(file.get(), name);
  return bytes;
}

namespace {

/// CTest gives every test a working folder of its own; a test that is run by hand leaves nothing where it was started.
std::filesystem::path folder_of_folders(MPI_Comm comm) {
  const std::filesystem::path here = std::filesystem::current_path();
  const std::filesystem::path runs = std::filesystem::path(ORBWEAVER_BINARY_DIR) / "test_runs";
  if (std::mismatch(runs.begin(), runs.end(), here.begin(), here.end()).first == runs.end()) return {};
  long of_root = getpid();
  MPI_Bcast(&of_root, 1, MPI_LONG, 0, comm);
  return std::filesystem::temp_directory_path() / fmt::format("orbweaver_test_{}", of_root);
}

}  // namespace

std::filesystem::path fresh_folder(const std::string& name, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Barrier(comm);
  const std::filesystem::path folder = folder_of_folders(comm) / name;
  if (rank == 0) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  MPI_Barrier(comm);
  return folder;
}

void remove_checksums(const std::filesystem::path& atlas) {
  const H5Handle file(check_h5(H5Fopen(atlas.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "H5Fopen"), H5Fclose);
  for (const char* name : {"families", "orbits", "crossings", "sections", "loci", "equilibria", "findings"})
    check_h5(H5Ldelete(file.get(), fmt::format("{}/checksum", name).c_str(), H5P_DEFAULT), name);
  for (const char* name : {"orbits/modes_checksum", "orbits/time_map_checksum"})
    check_h5(H5Ldelete(file.get(), name, H5P_DEFAULT), name);
  check_h5(H5Adelete(file.get(), "checksum"), "checksum");
  const H5Handle minor(check_h5(H5Aopen(file.get(), "format_minor", H5P_DEFAULT), "format_minor"), H5Aclose);
  const std::int64_t before = 1;
  check_h5(H5Awrite(minor.get(), H5T_NATIVE_INT64, &before), "format_minor");
}

}  // namespace orbweaver::test
