#include "orbweaver/report/proof_text.hpp"

#include <fmt/format.h>

namespace orbweaver::report {

namespace {

using prove::Proof;
using prove::Stability;

/// Digits of an interval in a table.
constexpr int digits_in_table = 16;

std::string line(const std::string& label, const std::string& text) {
  return fmt::format("  {:<18} {}\n", label, text);
}

std::string held_text(const Proof& proof) {
  const refine::HeldValue& held = proof.statement.held;
  return fmt::format("{} = {}", held.quantity == refine::HeldValue::Quantity::period ? "T" : "E", held.decimal);
}

std::string multipliers_text(const Proof& proof) {
  const std::string index = proof.order == 1 ? "index" : fmt::format("index over T/{}", proof.order);
  switch (proof.stability) {
    case Stability::elliptic: return fmt::format("elliptic: |{}| < 2", index);
    case Stability::hyperbolic: return fmt::format("hyperbolic: |{}| > 2", index);
    case Stability::undecided: return fmt::format("undecided: 2 or -2 lies in the interval of the {}", index);
    case Stability::none: break;
  }
  return "no multipliers but the two trivial ones";
}

}  // namespace

std::string to_text(const Proof& proof) {
  const prove::Statement& statement = proof.statement;
  std::string parameters;
  for (const auto& [name, decimal] : statement.parameters)
    parameters += (parameters.empty() ? "" : ", ") + name + " = " + decimal;
  std::string text = fmt::format("{}, {}\n", statement.family, held_text(proof));
  text += line("system", parameters.empty() ? statement.system : fmt::format("{} ({})", statement.system, parameters));
  text += line("proven", fmt::format("exactly one orbit within {:.2e} of the centre; it lies within {:.2e}",
                                     proof.radius, proof.distance));
  text += line("isolated by", proof.isolated_by);
  text += line("period", proof.period.text());
  text += line("energy", proof.energy.text());
  for (std::size_t i = 0; i < proof.state.size(); ++i)
    text += line(i < statement.state_names.size() ? statement.state_names[i] + "(0)" : fmt::format("z{}(0)", i),
                 proof.state[i].text());
  if (proof.index) text += line("index", proof.index->text());
  if (proof.index && proof.order > 1)
    text += line(fmt::format("index over T/{}", proof.order), proof.fundamental_index->text());
  if (proof.multiplier.size() == 1) text += line("multiplier", proof.multiplier[0].text());
  if (proof.multiplier.size() == 2) {
    text += line("multiplier, real", proof.multiplier[0].text());
    text += line("imaginary", proof.multiplier[1].text());
  }
  return text + line("stability", multipliers_text(proof));
}

std::string proofs_table(const std::vector<Proof>& proofs, const std::vector<double>& seconds) {
  std::string text = fmt::format("{:<12} {:<10} {:>8} {:>9} {:>2} {:<34} {:<34} {:<10}{}\n", "family", "held", "radius",
                                 "known to", "p", "index over T/p", "multiplier, or its real part", "stability",
                                 seconds.empty() ? "" : "       s");
  for (std::size_t n = 0; n < proofs.size(); ++n) {
    const Proof& proof = proofs[n];
    text += fmt::format("{:<12} {:<10} {:>8.1e} {:>9.1e} {:>2} {:<34} {:<34} {:<10}{}\n", proof.statement.family,
                        held_text(proof), proof.radius, proof.distance, proof.order,
                        proof.fundamental_index ? proof.fundamental_index->text(digits_in_table) : "-",
                        proof.multiplier.empty() ? "-" : proof.multiplier.front().text(digits_in_table),
                        name_of(proof.stability), n < seconds.size() ? fmt::format(" {:>7.2f}", seconds[n]) : "");
  }
  return text;
}

}  // namespace orbweaver::report
