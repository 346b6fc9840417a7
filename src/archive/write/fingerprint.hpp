#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace orbweaver::archive {

/// Tells which orbits a segment holds, whatever their order: the sum modulo 2^64 over its rows of a hash of each.
/// (FNV-1a, 64 bits: Fowler, Noll, Vo; draft-eastlake-fnv. Sums of it over parts add up.)
class Fingerprint {
 public:
  void add(std::string_view family_key, std::int64_t step, double arclength, double period) {
    _hash = 14695981039346656037ULL;
    for (const char c : family_key) mix(static_cast<unsigned char>(c));
    mix_number(static_cast<std::uint64_t>(step));
    mix_number(std::bit_cast<std::uint64_t>(arclength));
    mix_number(std::bit_cast<std::uint64_t>(period));
    _sum += _hash;
  }

  [[nodiscard]] std::uint64_t value() const noexcept { return _sum; }

 private:
  void mix(unsigned char byte) { _hash = (_hash ^ byte) * 1099511628211ULL; }
  void mix_number(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) mix(static_cast<unsigned char>(number >> shift));
  }

  std::uint64_t _hash = 0;
  std::uint64_t _sum = 0;
};

}  // namespace orbweaver::archive
