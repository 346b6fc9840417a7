#include "show_verdicts.hpp"

#include <map>

#include <fmt/format.h>

#include "orbweaver/certificate/verdict.hpp"

namespace orbweaver::report {

namespace {

using certificate::Verdict;

std::map<std::int64_t, std::size_t> counts_of(const archive::Archive& atlas, std::size_t first, std::size_t count) {
  std::map<std::int64_t, std::size_t> counts;
  for (std::size_t row = first; row < first + count; ++row) ++counts[atlas.orbits().integers("verdict")[row]];
  return counts;
}

std::string name_of_number(std::int64_t verdict) {
  if (verdict < 0) return "no certificate";
  if (verdict > static_cast<std::int64_t>(last_of(Verdict{}))) return fmt::format("verdict {}", verdict);
  return std::string(name_of(static_cast<Verdict>(verdict)));
}

}  // namespace

std::string verdicts_text(const archive::Archive& atlas, std::size_t first, std::size_t count) {
  const auto counts = counts_of(atlas, first, count);
  if (counts.empty() || (counts.size() == 1 && counts.begin()->first < 0)) return "";
  std::string text;
  for (const auto& [verdict, orbits] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", orbits, name_of_number(verdict));
  return text;
}

std::string doubts_text(const archive::Archive& atlas, std::size_t family) {
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
  const auto count = static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]);
  std::string text;
  for (const auto& [verdict, orbits] : counts_of(atlas, first, count))
    if (verdict > static_cast<std::int64_t>(Verdict::holds))
      text += fmt::format("{}{} of {} orbits: {}", text.empty() ? "" : "; ", orbits, count, name_of_number(verdict));
  return text;
}

}  // namespace orbweaver::report
