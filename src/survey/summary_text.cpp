#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/survey/survey.hpp"

namespace orbweaver::survey {

std::string to_text(const Summary& summary) {
  std::size_t width = 6;
  for (const FamilySummary& f : summary.families) width = std::max(width, f.name.size());
  std::string text =
      fmt::format("{:<{}}  {:>6}  {:>22}  {:>26}  {}\n", "family", width, "orbits", "period", "energy", "ended by");
  for (const FamilySummary& f : summary.families)
    if (f.orbits == 0)
      text += fmt::format("{:<{}}  {:>6}  {:>22}  {:>26}  {}\n", f.name, width, 0, "-", "-", f.end_reason);
    else
      text += fmt::format("{:<{}}  {:>6}  {:>9.6f} .. {:>9.6f}  {:>11.8f} .. {:>11.8f}  {}\n", f.name, width, f.orbits,
                          f.period_from, f.period_to, f.energy_from, f.energy_to, f.end_reason);
  for (const std::string& remark : summary.remarks) text += fmt::format("note: {}\n", remark);
  for (const std::string& failed : summary.failed_tasks) text += fmt::format("failed: {}\n", failed);
  text += fmt::format("{} families, {} orbits, {} failed, {:.2f} s; peak memory per rank:", summary.families.size(),
                      summary.orbits, summary.failures, summary.seconds);
  for (const double mib : summary.peak_memory_mib) text += fmt::format(" {:.0f}", mib);
  text += fmt::format(" MiB\narchive: {}\n", summary.atlas.string());
  return text;
}

}  // namespace orbweaver::survey
