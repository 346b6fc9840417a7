#include "show_head.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/styled.hpp"
#include "stored_system.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t label_width = 13;  // as in the summary

/// The texts with commas between them; none is broken.
void print_labelled(std::ostream& out, const std::string& label, const std::vector<std::string>& texts,
                    std::size_t width) {
  std::string line = fmt::format("{:<{}}", label, label_width);
  for (std::size_t n = 0; n < texts.size(); ++n) {
    if (n > 0 && line.size() + 2 + texts[n].size() > width) {
      out << line << ",\n";
      line = std::string(label_width, ' ') + texts[n];
    } else {
      line += (n == 0 ? "" : ", ") + texts[n];
    }
  }
  out << line << '\n';
}

/// "m1 = 1 kg": the words of one stay on a line.
std::vector<std::string> parameter_texts(const archive::Header& header) {
  const std::vector<std::string> units = units_of(header);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < units.size(); ++i)
    texts.push_back(fmt::format("{} = {:.15g}{}", header.parameter_names[i], header.parameter_values[i],
                                units[i].empty() || units[i] == "1" ? "" : " " + units[i]));
  return texts;
}

std::vector<std::string> units_texts(const archive::Archive& atlas) {
  const archive::Header& header = atlas.header();
  std::vector<std::string> angles;
  for (const int angle : known_angles_of(header).value_or(std::vector<int>{}))
    angles.push_back(header.state_names[static_cast<std::size_t>(angle)]);
  std::vector<std::string> texts{
      fmt::format("times{} and states in the units of the parameters", has_energies(atlas) ? ", energies" : "")};
  if (!angles.empty()) texts.insert(texts.begin(), fmt::format("{} in radians", fmt::join(angles, ", ")));
  return texts;
}

}  // namespace

void print_head(std::ostream& out, const archive::Archive& atlas, std::size_t width) {
  const archive::Header& header = atlas.header();
  if (header.system.empty()) return;  // format_minor 0
  const systems::ModelInfo* info = info_of(header);
  out << core::Styled{core::Style::heading, header.system};
  if (info != nullptr) out << fmt::format(": {}", info->title);
  if (!header.effects.empty()) out << fmt::format(", with {}", fmt::join(header.effects, ", "));
  out << '\n';
  if (!header.parameter_names.empty()) print_labelled(out, "parameters", parameter_texts(header), width);
  print_labelled(out, "units", units_texts(atlas), width);
}

}  // namespace orbweaver::report
