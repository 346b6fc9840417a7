#include "orbweaver/report/summary_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace orbweaver::report {

namespace {

/// Families that a summary lists; `orbweaver show` lists all.
constexpr std::size_t most_listed = 60;
/// Findings of one severity that it lists.
constexpr std::size_t most_findings = 20;

/// With a fixed number of decimals where these hold the value, whatever its unit; else in powers of ten.
std::string number_text(double value, int width, int decimals) {
  const double size = std::abs(value);
  const bool is_held = size == 0.0 || (size >= std::pow(10.0, 4 - decimals) && size < 1e6);
  return is_held ? fmt::format("{:>{}.{}f}", value, width, decimals) : fmt::format("{:>{}.6e}", value, width);
}

std::string line_of(const survey::FamilySummary& f, std::size_t width) {
  const std::string name = std::string(2 * static_cast<std::size_t>(f.depth), ' ') + f.name;
  const std::string end = f.doubts.empty() ? f.end_reason : fmt::format("{}; {}", f.end_reason, f.doubts);
  if (f.orbits == 0) return fmt::format("{:<{}}  {:>6}  {:>22}  {:>26}  {}\n", name, width, 0, "-", "-", f.end_reason);
  return fmt::format("{:<{}}  {:>6}  {} .. {}  {} .. {}  {}\n", name, width, f.orbits, number_text(f.period_from, 9, 6),
                     number_text(f.period_to, 9, 6), number_text(f.level_from, 11, 8), number_text(f.level_to, 11, 8),
                     end);
}

/// What does not add up, and how much the limits cut; failed tasks have lines of their own.
std::string findings_text(const survey::Summary& summary) {
  if (!summary.archived) return "";
  std::string text;
  std::map<survey::Severity, std::size_t> counts;
  for (const survey::FindingSummary& finding : summary.findings) {
    const std::size_t number = counts[finding.severity]++;
    const bool is_listed =
        finding.severity == survey::Severity::contradiction || finding.severity == survey::Severity::undecided;
    if (is_listed && number < most_findings)
      text += fmt::format("{}: {}\n", survey::name_of(finding.severity), finding.text);
  }
  return text +
         fmt::format("findings: {} contradictions, {} undecided, {} cut by limits (orbweaver show {} findings)\n",
                     counts[survey::Severity::contradiction], counts[survey::Severity::undecided],
                     counts[survey::Severity::cut], summary.atlas.string());
}

}  // namespace

std::string to_text(const survey::Summary& summary) {
  std::size_t width = 6;
  for (const survey::FamilySummary& f : summary.families)
    width = std::max(width, f.name.size() + 2 * static_cast<std::size_t>(f.depth));
  std::string text = fmt::format("{:<{}}  {:>6}  {:>22}  {:>26}  {}\n", "family", width, "orbits", "period",
                                 summary.parameter.empty() ? "energy" : summary.parameter, "ended by");
  const std::size_t listed = std::min(summary.families.size(), most_listed);
  for (std::size_t n = 0; n < listed; ++n) text += line_of(summary.families[n], width);
  if (listed < summary.families.size())
    text += fmt::format("... and {} more: orbweaver show {} families\n", summary.families.size() - listed,
                        summary.atlas.string());
  for (const std::string& remark : summary.remarks) text += fmt::format("note: {}\n", remark);
  for (const std::string& failed : summary.failed_tasks) text += fmt::format("failed: {}\n", failed);
  text += findings_text(summary);
  const auto left_out = std::count_if(summary.families.begin(), summary.families.end(),
                                      [](const survey::FamilySummary& f) { return f.orbits == 0 && !f.failed; });
  text += fmt::format("{} families{}, {} crossings, {} orbits, {} failed", summary.families.size(),
                      left_out > 0 ? fmt::format(" ({} of them left out by limits)", left_out) : "", summary.crossings,
                      summary.orbits, summary.failures);
  if (!summary.peak_memory_mib.empty())
    text += fmt::format(", {:.2f} s; peak memory per rank: {:.0f} MiB", summary.seconds,
                        fmt::join(summary.peak_memory_mib, " "));
  text += "\n";
  if (summary.archived)
    text += fmt::format("archive: {}\n", summary.atlas.string());
  else
    text += fmt::format("archive: not written (orbweaver consolidate {} makes it of what there is)\n",
                        summary.atlas.parent_path().string());
  return text;
}

}  // namespace orbweaver::report
