#include "orbweaver/report/summary_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/command_line.hpp"
#include "orbweaver/core/styled.hpp"

namespace orbweaver::report {

namespace {

using core::Style;
using core::Styled;

/// Families that a summary lists; `orbweaver show` lists all.
constexpr std::size_t most_listed = 60;
/// Findings of one severity that it lists.
constexpr std::size_t most_findings = 20;
constexpr std::size_t most_notes = 12;

/// With a fixed number of decimals where these hold the value, whatever its unit; else in powers of ten.
std::string number_text(double value, int width, int decimals) {
  const double size = std::abs(value);
  const bool is_held = size == 0.0 || (size >= std::pow(10.0, 4 - decimals) && size < 1e6);
  return is_held ? fmt::format("{:>{}.{}f}", value, width, decimals) : fmt::format("{:>{}.6e}", value, width);
}

std::string line_of(const survey::FamilySummary& f, std::size_t width) {
  const std::string name = std::string(2 * static_cast<std::size_t>(f.depth), ' ') + f.name;
  const std::string end = f.doubts.empty() ? f.end_reason : fmt::format("{}; {}", f.end_reason, f.doubts);
  if (f.orbits == 0) return fmt::format("{:<{}}  {:>6}  {:>22}  {:>26}  {}", name, width, 0, "-", "-", f.end_reason);
  return fmt::format("{:<{}}  {:>6}  {} .. {}  {} .. {}  {}", name, width, f.orbits, number_text(f.period_from, 9, 6),
                     number_text(f.period_to, 9, 6), number_text(f.level_from, 11, 8), number_text(f.level_to, 11, 8),
                     end);
}

struct Listing {
  std::size_t listed;  // at most
  std::string rest;    // how the others are to be had
};

Listing listing(Detail detail, std::size_t most, std::string rest) {
  return {detail == Detail::all ? std::numeric_limits<std::size_t>::max() : most, std::move(rest)};
}

/// "note: TEXT" for each, the word in a style.
void print_lines(std::ostream& out, const std::vector<std::string>& texts, std::string_view word, Style style,
                 const Listing& how) {
  const std::size_t listed = std::min(texts.size(), how.listed);
  for (std::size_t n = 0; n < listed; ++n) out << Styled{style, word} << ": " << texts[n] << '\n';
  if (listed < texts.size()) out << fmt::format("... and {} more: {}\n", texts.size() - listed, how.rest);
}

std::vector<std::string> texts_of(const survey::Summary& summary, survey::Severity severity) {
  std::vector<std::string> texts;
  for (const survey::FindingSummary& finding : summary.findings)
    if (finding.severity == severity) texts.push_back(finding.text);
  return texts;
}

void print_counts(std::ostream& out, const survey::Summary& summary) {
  const auto left_out = std::count_if(summary.families.begin(), summary.families.end(),
                                      [](const survey::FamilySummary& f) { return f.orbits == 0 && !f.failed; });
  out << fmt::format("{} families{}, {} crossings, {} orbits, ", summary.families.size(),
                     left_out > 0 ? fmt::format(" ({} of them left out by limits)", left_out) : "", summary.crossings,
                     summary.orbits)
      << Styled{summary.failures > 0 ? Style::bad : Style::plain, fmt::format("{} failed", summary.failures)};
  if (!summary.peak_memory_mib.empty())
    out << fmt::format(", {:.2f} s; peak memory per rank: {:.0f} MiB", summary.seconds,
                       fmt::join(summary.peak_memory_mib, " "));
  out << '\n';
}

/// What does not add up, and how much the limits cut; failed tasks have lines of their own.
void print_findings(std::ostream& out, const survey::Summary& summary, Detail detail) {
  if (!summary.archived) return;
  const std::string show = core::command_line({"show", summary.atlas.string(), "findings"});
  const auto contradictions = texts_of(summary, survey::Severity::contradiction);
  const auto undecided = texts_of(summary, survey::Severity::undecided);
  const std::string counts[] = {fmt::format("{} contradictions", contradictions.size()),
                                fmt::format("{} undecided", undecided.size())};
  out << "findings: " << Styled{contradictions.empty() ? Style::plain : Style::bad, counts[0]} << ", "
      << Styled{undecided.empty() ? Style::plain : Style::warning, counts[1]}
      << fmt::format(", {} cut by limits ({})\n", texts_of(summary, survey::Severity::cut).size(), show);
  print_lines(out, contradictions, survey::name_of(survey::Severity::contradiction), Style::bad,
              listing(detail, most_findings, show));
  print_lines(out, undecided, survey::name_of(survey::Severity::undecided), Style::warning,
              listing(detail, most_findings, show));
}

void print_notes(std::ostream& out, const survey::Summary& summary, Detail detail) {
  print_lines(out, summary.remarks, "note", Style::heading, listing(detail, most_notes, "--verbose"));
  if (detail == Detail::all)
    print_lines(out, summary.passed_over, "note", Style::heading, listing(detail, 0, ""));
  else if (!summary.passed_over.empty())
    out << Styled{Style::faint, fmt::format("passed over at {} equilibria: dips of the sweep that begin no family "
                                            "(orbweaver sweep SCENE lists them)",
                                            summary.passed_over.size())}
        << '\n';
}

void print_families(std::ostream& out, const survey::Summary& summary, Detail detail) {
  std::size_t width = 6;
  for (const survey::FamilySummary& f : summary.families)
    width = std::max(width, f.name.size() + 2 * static_cast<std::size_t>(f.depth));
  out << Styled{Style::heading, fmt::format("{:<{}}  {:>6}  {:>22}  {:>26}  {}", "family", width, "orbits", "period",
                                            summary.parameter.empty() ? "energy" : summary.parameter, "ended by")}
      << '\n';
  const std::size_t listed = std::min(summary.families.size(), listing(detail, most_listed, "").listed);
  for (std::size_t n = 0; n < listed; ++n)
    out << Styled{summary.families[n].failed ? Style::bad : Style::plain, line_of(summary.families[n], width)} << '\n';
  if (listed < summary.families.size())
    out << fmt::format("... and {} more: {}\n", summary.families.size() - listed,
                       core::command_line({"show", summary.atlas.string(), "families"}));
}

}  // namespace

void print(std::ostream& out, const survey::Summary& summary, Detail detail) {
  print_counts(out, summary);
  print_lines(out, summary.failed_tasks, "failed", Style::bad, listing(detail, most_findings, "--verbose"));
  print_findings(out, summary, detail);
  print_notes(out, summary, detail);
  if (!summary.families.empty()) {
    out << '\n';
    print_families(out, summary, detail);
    out << '\n';
  }
  if (summary.archived)
    out << fmt::format("archive: {}\n", summary.atlas.string());
  else
    out << fmt::format("archive: not written ({} makes it of what there is)\n",
                       core::command_line({"consolidate", summary.atlas.parent_path().string()}));
}

std::string to_text(const survey::Summary& summary, Detail detail) {
  std::ostringstream out;
  print(out, summary, detail);
  return out.str();
}

}  // namespace orbweaver::report
