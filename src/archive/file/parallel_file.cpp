#include "parallel_file.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "h5_types.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/pause.hpp"
#include "orbweaver/core/posix_file.hpp"

namespace orbweaver::archive {

ParallelFile::ParallelFile(MPI_Comm comm, std::filesystem::path path, const FileLayout& layout)
    : _comm(comm), _path(std::move(path)), _part(_path.string() + ".part") {
  quiet_h5();
  try {
    core::collectively(_comm, [&] {
      if (core::rank_of(_comm) == 0) create_layout_file(_part, layout);
    });
    open_together();
  } catch (...) {
    abandon();
    throw;
  }
}

ParallelFile::~ParallelFile() {
  if (!_published) abandon();
}

void ParallelFile::abandon() noexcept {
  _datasets.clear();
  _file = H5Handle();
  if (core::rank_of(_comm) == 0) std::remove(_part.c_str());
}

void ParallelFile::open_together() {
  // Open MPI hangs when opening fails on some ranks only.
  core::collectively(_comm, [&] { core::expect_writable(_part); });
  core::collectively(_comm, [&] {
    const H5Handle access(check_h5(H5Pcreate(H5P_FILE_ACCESS), "H5Pcreate"), H5Pclose);
    check_h5(H5Pset_fapl_mpio(access.get(), _comm, MPI_INFO_NULL), "H5Pset_fapl_mpio");
    const hid_t file = H5Fopen(_part.c_str(), H5F_ACC_RDWR, access.get());
    _file = {check_h5(file, fmt::format("cannot open '{}' on all ranks", _part.string())), H5Fclose};
  });
}

void ParallelFile::write_table(const Table& mine, std::uint64_t first) {
  core::collectively(_comm, [&] {
    for (const Column& column : mine.columns())
      write_column(mine.name() + '/' + column.spec.name, column, mine.rows(), first);
  });
}

void ParallelFile::write_flat(const std::string& name, std::span<const double> mine, std::uint64_t first) {
  core::collectively(_comm, [&] { write_rows(name, H5T_NATIVE_DOUBLE, mine.data(), {mine.size()}, first); });
}

void ParallelFile::write_column(const std::string& name, const Column& mine, std::uint64_t rows, std::uint64_t first) {
  std::vector<hsize_t> extents{rows};
  extents.insert(extents.end(), mine.spec.row_shape.begin(), mine.spec.row_shape.end());
  const H5Handle type = h5_memory_type(mine.spec);
  if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&mine.values)) {
    write_rows(name, type.get(), integers->data(), extents, first);
  } else if (const auto* reals = std::get_if<std::vector<double>>(&mine.values)) {
    write_rows(name, type.get(), reals->data(), extents, first);
  } else {
    const std::string block = padded_texts(std::get<std::vector<std::string>>(mine.values), mine.spec.text_width);
    write_rows(name, type.get(), block.data(), extents, first);
  }
}

void ParallelFile::write_rows(const std::string& name, hid_t memory_type, const void* data,
                              const std::vector<hsize_t>& extents, std::uint64_t first) {
  if (std::find(extents.begin(), extents.end(), hsize_t{0}) != extents.end()) return;
  const std::string doing = fmt::format("cannot write /{} to '{}'", name, _part.string());
  H5Handle& dataset = _datasets[name];
  if (dataset.empty()) dataset = {check_h5(H5Dopen2(_file.get(), name.c_str(), H5P_DEFAULT), doing), H5Dclose};
  const H5Handle place(check_h5(H5Dget_space(dataset.get()), doing), H5Sclose);
  std::vector<hsize_t> start(extents.size(), 0);
  start[0] = first;
  check_h5(H5Sselect_hyperslab(place.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(), nullptr), doing);
  const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  const H5Handle memory(check_h5(space, doing), H5Sclose);
  check_h5(H5Dwrite(dataset.get(), memory_type, memory.get(), place.get(), H5P_DEFAULT, data), doing);
}

void ParallelFile::close_together() {
  core::collectively(_comm, [&] {
    _datasets.clear();
    if (!_file.empty()) _file.close(fmt::format("cannot close '{}'", _part.string()));
  });
}

const std::filesystem::path& ParallelFile::pause() {
  close_together();
  return _part;
}

void ParallelFile::add_table(const Table& mine) {
  close_together();
  core::collectively(_comm, [&] {
    if (core::rank_of(_comm) == 0) add_table_to_file(_part, mine.spec(), mine.rows());
  });
  open_together();
  write_table(mine, 0);
}

void ParallelFile::publish() {
  close_together();
  core::collectively(_comm, [&] { core::sync_file(_part); });
  core::collectively(_comm, [&] {
    if (core::rank_of(_comm) != 0) return;
    core::pause_point("publish " + _path.filename().string());
    core::rename_file(_part, _path);
  });
  _published = true;
}

void agree_on_text_widths(MPI_Comm comm, Table& table) {
  for (Column& column : table.columns())
    if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
      column.spec.text_width = core::greatest(comm, longest_text(*texts));
}

}  // namespace orbweaver::archive
