#include "family_names.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "arclengths.hpp"

namespace orbweaver::survey {

namespace {

/// The kind of a family in its name: B, D, T3, ...
std::string kind_letter(int multiplicity) {
  if (multiplicity == 1) return "B";
  return multiplicity == 2 ? "D" : fmt::format("T{}", multiplicity);
}

/// What is born on one family, as many times around it.
struct Births {
  std::set<std::pair<double, std::string>> places;          // arclength and key of crossings
  std::map<std::string, std::vector<std::string>> born_at;  // keys of families, by crossing
};

/// Its place in a sorted range, from 0.
template <typename Range, typename Value>
std::size_t ordinal(const Range& range, const Value& value) {
  return static_cast<std::size_t>(std::distance(range.begin(), std::find(range.begin(), range.end(), value)));
}

}  // namespace

std::string twin_letters(std::size_t n) {
  constexpr std::size_t letters = 26;
  std::string text;
  for (std::size_t left = n + 1; left > 0; left = (left - 1) / letters)
    text.insert(text.begin(), static_cast<char>('a' + (left - 1) % letters));
  return text;
}

void name_families(std::vector<Family>& families, const Crossings& crossings,
                   const std::map<std::string, std::string>& letters) {
  const Arclengths arclengths(families);
  std::map<std::pair<std::string, int>, Births> births;  // by parent and multiplicity
  for (const Family& family : families) {
    if (family.lineage.depth == 0) continue;
    const LocateOutcome& crossing = crossings.at(family.lineage.crossing);
    Births& at = births[{crossing.lineage.family, family.lineage.multiplicity}];
    at.places.insert({arclengths.of(crossing), crossing.key});
    at.born_at[crossing.key].push_back(family.key);
  }
  for (auto& [parent, at] : births)
    for (auto& [crossing, born] : at.born_at) std::sort(born.begin(), born.end());

  std::map<std::string, std::string> prefix;
  std::set<std::string> taken;
  for (Family& family : families) {
    if (family.lineage.depth == 0) {
      const auto letter = letters.find(family.name);
      prefix[family.key] = letter != letters.end() ? letter->second : family.name + " ";
      taken.insert(family.name);
      continue;
    }
    const LocateOutcome& crossing = crossings.at(family.lineage.crossing);
    const Births& at = births.at({crossing.lineage.family, family.lineage.multiplicity});
    const std::string kind = kind_letter(family.lineage.multiplicity);
    family.name = prefix.at(crossing.lineage.family) + kind;
    if (at.places.size() > 1) {
      const std::size_t number = ordinal(at.places, std::pair(arclengths.of(crossing), crossing.key)) + 1;
      family.name += fmt::format("{}{}", kind.size() > 1 ? "-" : "", number);
    }
    const std::vector<std::string>& born = at.born_at.at(crossing.key);
    if (born.size() > 1) family.name += twin_letters(ordinal(born, family.key));
    // Letters of the scene may read like another family's kind: those of I and ID lead to two families IDB.
    if (!taken.insert(family.name).second) family.name += fmt::format(" ({})", family.key);
    prefix[family.key] = family.name;
  }
}

std::map<std::string, std::string> names_by_key(const std::vector<Family>& families) {
  std::map<std::string, std::string> names;
  for (const Family& family : families) names[family.key] = family.name;
  return names;
}

}  // namespace orbweaver::survey
