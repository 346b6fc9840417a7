#include "orbweaver/report/compare/comparison_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t indent = 4;

std::string size_text(const char* which, const AtlasSize& size) {
  return fmt::format("{}: {} ({} families, {} crossings, {} orbits)\n", which, size.path, size.families, size.crossings,
                     size.orbits);
}

std::string title_of(const Difference& difference) {
  if (difference.family_a.empty()) return difference.family_b;
  if (difference.family_b.empty() || difference.family_a == difference.family_b) return difference.family_a;
  return fmt::format("{} ({} in B)", difference.family_a, difference.family_b);
}

std::string json_lines(const std::vector<std::string>& values) {
  return values.empty() ? "[]" : fmt::format("[\n    {}\n  ]", fmt::join(values, ",\n    "));
}

std::string json_size(const AtlasSize& size) {
  return fmt::format(R"({{"path": {}, "families": {}, "crossings": {}, "orbits": {}}})", json_text(size.path),
                     size.families, size.crossings, size.orbits);
}

}  // namespace

void print_comparison(std::ostream& out, const Comparison& comparison) {
  out << size_text("A", comparison.a) << size_text("B", comparison.b);
  for (const std::string& note : comparison.notes) out << "note: " << note << '\n';
  std::string title;
  for (const Difference& difference : comparison.differences) {
    if (title_of(difference) != title) out << (title = title_of(difference)) << '\n';
    for (const std::string& line : wrap(difference.text, line_width, title.empty() ? 0 : indent)) out << line << '\n';
  }
  if (!comparison.renamed.empty()) {
    std::vector<std::string> pairs;
    for (const Renaming& pair : comparison.renamed) pairs.push_back(fmt::format("{} -> {}", pair.a, pair.b));
    for (const std::string& line : wrap(fmt::format("named otherwise: {}", fmt::join(pairs, ", ")), line_width, 0))
      out << line << '\n';
  }
  if (!comparison.largest.empty()) {
    TextGrid grid;
    std::vector<std::string> quantities, values, allowed, places;
    for (const LargestDeviation& d : comparison.largest) {
      quantities.push_back(d.quantity);
      values.push_back(fmt::format("{:.2e}", d.value));
      allowed.push_back(fmt::format("{:.1e}", d.allowed));
      places.push_back(d.where);
    }
    grid.add_column("largest deviation", std::move(quantities), false);
    grid.add_column("relative", std::move(values));
    grid.add_column("allowed", std::move(allowed));
    grid.add_column("where", std::move(places), false);
    grid.print(out);
  }
  out << fmt::format("in both: {} families, {} crossings; {} orbits lie on the other's curves, {} loops compared\n",
                     comparison.families, comparison.crossings, comparison.orbits, comparison.loops);
  out << (comparison.same() ? std::string("the same\n")
                            : fmt::format("{} {}\n", comparison.differences.size(),
                                          comparison.differences.size() == 1 ? "difference" : "differences"));
}

void print_comparison_json(std::ostream& out, const Comparison& comparison) {
  std::vector<std::string> differences, renamed, notes, largest;
  for (const Difference& d : comparison.differences)
    differences.push_back(
        fmt::format(R"({{"kind": {}, "family_a": {}, "family_b": {}, "text": {}, "by": {}, "allowed": {}}})",
                    json_text(std::string(name_of(d.kind))), json_text(d.family_a), json_text(d.family_b),
                    json_text(d.text), json_number(d.by), json_number(d.allowed)));
  for (const Renaming& pair : comparison.renamed)
    renamed.push_back(fmt::format(R"({{"a": {}, "b": {}}})", json_text(pair.a), json_text(pair.b)));
  for (const std::string& note : comparison.notes) notes.push_back(json_text(note));
  for (const LargestDeviation& d : comparison.largest)
    largest.push_back(fmt::format(R"({{"quantity": {}, "value": {}, "allowed": {}, "where": {}}})",
                                  json_text(d.quantity), json_number(d.value), json_number(d.allowed),
                                  json_text(d.where)));
  out << fmt::format("{{\n  \"same\": {},\n  \"a\": {},\n  \"b\": {},\n", comparison.same(), json_size(comparison.a),
                     json_size(comparison.b));
  out << fmt::format("  \"matched\": {{\"families\": {}, \"crossings\": {}, \"orbits\": {}, \"loops\": {}}},\n",
                     comparison.families, comparison.crossings, comparison.orbits, comparison.loops);
  out << fmt::format("  \"differences\": {},\n  \"renamed\": {},\n  \"notes\": {},\n  \"largest\": {}\n}}\n",
                     json_lines(differences), json_lines(renamed), json_lines(notes), json_lines(largest));
}

}  // namespace orbweaver::report
