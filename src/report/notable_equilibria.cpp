#include "notable_equilibria.hpp"

#include <cstdint>
#include <string>

namespace orbweaver::report {

std::vector<std::size_t> notable_equilibria(const archive::Table& equilibria) {
  const std::vector<std::int64_t>& numbers = equilibria.integers("equilibrium");
  const std::vector<std::int64_t>& steps = equilibria.integers("step");
  const std::vector<std::string>& kinds = equilibria.texts("kind");
  const std::vector<std::string>& stabilities = equilibria.texts("stability");
  const std::vector<std::string>& notes = equilibria.texts("note");
  const auto is_event = [&](std::size_t row) { return kinds[row] != "equilibrium"; };
  const auto differs = [&](std::size_t row, std::size_t beside) {  // beside: a neighbour's row, on the same curve
    return !is_event(row) && !is_event(beside) && stabilities[row] != stabilities[beside];
  };
  std::vector<std::size_t> notable;
  for (std::size_t row = 0; row < equilibria.rows(); ++row) {
    const bool has_before = row > 0 && numbers[row - 1] == numbers[row];
    const bool has_behind = row + 1 < equilibria.rows() && numbers[row + 1] == numbers[row];
    if (!has_before || !has_behind || steps[row] == 0 || is_event(row) || !notes[row].empty() ||
        differs(row, row - 1) || differs(row, row + 1))
      notable.push_back(row);
  }
  return notable;
}

}  // namespace orbweaver::report
