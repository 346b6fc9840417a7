#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include <mpi.h>

#include "h5_handle.hpp"
#include "layout_file.hpp"

namespace orbweaver::archive {

/// An HDF5 file that all ranks of a communicator write together under the name PATH.part and rename to PATH when it is
/// whole and on the disk. Every member is collective. Whatever fails on one rank (EnvironmentError) is thrown on all;
/// a file that was not published is removed with the object.
///
/// Rank 0 lays the file out, so that afterwards no rank changes metadata; then all ranks open it through the MPI-IO
/// driver and write their rows at the same time. The transfers are independent: in a collective one, a rank whose disk
/// fails leaves the others waiting inside HDF5 1.10 for ever.
class ParallelFile {
 public:
  /// All ranks pass the same arguments (text widths included).
  ParallelFile(MPI_Comm comm, std::filesystem::path path, const FileLayout& layout);
  ParallelFile(const ParallelFile&) = delete;
  ParallelFile& operator=(const ParallelFile&) = delete;
  ~ParallelFile();

  /// Writes this rank's rows of every column, the first of them at row `first`; ranks may have no rows.
  void write_table(const Table& mine, std::uint64_t first);
  /// Writes this rank's part of a flat dataset; parts may be empty.
  void write_flat(const std::string& name, std::span<const double> mine, std::uint64_t first);

  /// Closes the file, so that every rank may open it for reading under the name that it has until it is published.
  /// Returns that name.
  const std::filesystem::path& pause();
  /// Adds a table of which rank 0 has all rows and the others none (text widths agreed on), and writes it.
  void add_table(const Table& mine);

  /// Closes, syncs, renames. Afterwards the object is only good for destruction.
  void publish();

 private:
  void close_together();
  void open_together();
  void write_column(const std::string& name, const Column& mine, std::uint64_t rows, std::uint64_t first);
  void write_rows(const std::string& name, hid_t memory_type, const void* data, const std::vector<hsize_t>& extents,
                  std::uint64_t first);
  void abandon() noexcept;

  MPI_Comm _comm;
  std::filesystem::path _path;
  std::filesystem::path _part;
  bool _published = false;
  H5Handle _file;
  std::map<std::string, H5Handle> _datasets;
};

/// Collective. Sets the width of each text column to the longest text of any rank (at least 1).
void agree_on_text_widths(MPI_Comm comm, Table& table);

}  // namespace orbweaver::archive
