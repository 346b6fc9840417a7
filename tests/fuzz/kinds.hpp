#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fuzz/mutator.hpp"

namespace orbweaver::fuzz {

/// A kind of input from outside. A reader that comes gets a function here and its line in main.cpp.
struct Kind {
  std::function<std::string(Mutator&)> make;
  /// Reads it as the program would. Throws InputError, by which it ends with status 2, for what is refused, and
  /// WrongReading for what was read and should not have been.
  std::function<void(const std::string&)> read;
};

struct WrongReading {
  std::string what;
};

Kind scenes();        ///< the shipped and the tested ones, changed
Kind grown_scenes();  ///< keys, values and structures put together
Kind overrides();     ///< words behind --set, one a line
Kind messages();      ///< of the queue, half of them with a right checksum

Kind models();        ///< the texts of the shipped systems, changed
Kind loops();         ///< in CSV, as starts
Kind descriptions();  ///< names and meanings that models bring

/// Files are written into `folder`, which exists and is empty.
Kind archives(const std::filesystem::path& folder);
Kind segments(const std::filesystem::path& folder);
Kind checkpoints(const std::filesystem::path& folder);  ///< half of them with a right checksum
Kind journals(const std::filesystem::path& folder);     ///< the same
Kind payloads(const std::filesystem::path& folder);     ///< that tasks in both say where they lie

Kind proofs(const std::filesystem::path& folder);          ///< files of `verify --prove`
Kind start_archives(const std::filesystem::path& folder);  ///< whose orbits a scene starts from

[[nodiscard]] std::string bytes_of(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

}  // namespace orbweaver::fuzz
