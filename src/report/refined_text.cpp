#include "orbweaver/report/refined_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/numerics/extended.hpp"

namespace orbweaver::report {

namespace {

using numerics::Extended;
using refine::Number;

struct Line {
  std::string label;
  std::string value;
  std::string error;
};

/// Rounded up to two digits.
std::string bound_text(double log10_of_bound) {
  double exponent = std::floor(log10_of_bound);
  double digits = std::ceil(10.0 * std::pow(10.0, log10_of_bound - exponent)) / 10.0;
  if (digits >= 10.0) {
    digits /= 10.0;
    exponent += 1.0;
  }
  return fmt::format("{:.1f}e{:.0f}", digits, exponent);
}

/// Of a decimal number that `digits` digits hold, without the zeros at its end.
std::string exact_text(const Extended& value, int digits) {
  std::string text = numerics::decimal_text(value, digits);
  const std::size_t exponent = std::min(text.find('e'), text.size());
  std::size_t end = exponent;
  if (text.find('.') < exponent)
    while (text[end - 1] == '0') --end;
  if (text[end - 1] == '.') --end;
  return text.substr(0, end) + text.substr(exponent);
}

Line line_of(const std::string& label, const Number& number, const refine::RefinedOrbit& orbit) {
  constexpr int guard = 3;  // of the arithmetic in which an exact number is held
  if (number.error == 0) return {label, exact_text(number.value, orbit.working_digits - guard), "exact"};
  const int digits = orbit.digits;
  const double size = numerics::log10_abs(number.value);
  const double error = numerics::log10_abs(number.error);
  if (error >= size) return {label, "0", bound_text(numerics::log10_abs(Extended(number.error + abs(number.value))))};
  // As many digits as the bound allows: half a unit of the last one is their rounding.
  const int shown = std::clamp(static_cast<int>(std::floor(size - error)), 1, digits);
  const double half_unit = std::log10(0.5) + std::floor(size) + 1.0 - shown;
  const double total = half_unit + std::log10(1.0 + std::pow(10.0, error - half_unit));
  return {label, numerics::decimal_text(number.value, shown), bound_text(total)};
}

std::string parameter_texts(const systems::System& system) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : system.parameters())
    texts.push_back(fmt::format("{} = {}", name, numerics::shortest_decimal(value)));
  return fmt::format("{} ({})", system.info().name, fmt::join(texts, ", "));
}

std::string start_text(const systems::System& system, const refine::RefinedOrbit& orbit) {
  if (orbit.largest) return fmt::format("where {} is largest", system.info().state_names[*orbit.largest]);
  if (orbit.reversor.empty()) return "where the drive's phase is 0";
  return fmt::format("on the fixed set of {}, where {} is larger than half a period later", orbit.reversor,
                     system.info().state_names.front());
}

}  // namespace

std::string refined_text(const std::string& title, const RefinedLabels& labels, const systems::System& system,
                         const refine::RefinedOrbit& orbit) {
  RefinedLabels heading{{"system", parameter_texts(system)}};
  heading.insert(heading.end(), labels.begin(), labels.end());
  heading.emplace_back("t = 0", start_text(system, orbit));
  std::string text = title + "\n";
  for (const auto& [label, words] : heading) text += fmt::format("  {:<19}{}\n", label, words);
  std::vector<Line> lines{line_of("period", orbit.period, orbit)};
  if (orbit.energy) lines.push_back(line_of("energy", *orbit.energy, orbit));
  for (std::size_t i = 0; i < orbit.state.size(); ++i)
    lines.push_back(line_of(system.info().state_names[i] + "(0)", orbit.state[i], orbit));
  if (orbit.index) {
    lines.push_back(line_of("index", *orbit.index, orbit));
    if (orbit.order > 1)
      lines.push_back(line_of(fmt::format("index over T/{}", orbit.order), *orbit.fundamental_index, orbit));
  }
  const char* names[2][2] = {{"multiplier", "its inverse"}, {"multiplier, real", "imaginary"}};
  for (std::size_t i = 0; i < orbit.multipliers.size(); ++i)
    lines.push_back(line_of(names[orbit.unit_circle ? 1 : 0][i], orbit.multipliers[i], orbit));
  for (const refine::ComplexNumber& multiplier : orbit.spectrum) {
    lines.push_back(line_of(multiplier.imaginary ? "multiplier, real" : "multiplier", multiplier.real, orbit));
    if (multiplier.imaginary) lines.push_back(line_of("imaginary, +-", *multiplier.imaginary, orbit));
  }
  std::size_t width = 0;
  for (const Line& line : lines) width = std::max(width, line.value.size() + (line.value.front() == '-' ? 0 : 1));
  for (const Line& line : lines) {
    const std::string value = (line.value.front() == '-' ? "" : " ") + line.value;
    const std::string error = line.error == "exact" ? line.error : "+- " + line.error;
    text += fmt::format("  {:<18}{:<{}}  {}\n", line.label, value, width, error);
  }
  return text;
}

}  // namespace orbweaver::report
