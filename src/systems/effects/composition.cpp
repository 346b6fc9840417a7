#include "composition.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace orbweaver::systems {

namespace {

bool any_drives(const std::vector<EffectRules>& effects) {
  return std::any_of(effects.begin(), effects.end(), [](const EffectRules& effect) { return effect.drives; });
}

PhaseShift both(PhaseShift a, PhaseShift b) {
  if (a == PhaseShift::any) return b;
  if (b == PhaseShift::any || a == b) return a;
  return PhaseShift::broken;
}

Symmetry with_phase(const Symmetry& ideal, bool reverses, PhaseShift shift) {
  const Eigen::Index d = ideal.map.dimension();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(d + 1, d + 1);
  matrix.topLeftCorner(d, d) = ideal.map.matrix;
  matrix(d, d) = reverses ? -1.0 : 1.0;
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(d + 1);
  offset.head(d) = ideal.map.offset;
  offset(d) = shift == PhaseShift::half_turn ? std::numbers::pi : 0.0;
  return {ideal.name, {std::move(matrix), std::move(offset)}};
}

}  // namespace

ModelInfo with_effects(ModelInfo ideal, const std::vector<EffectRules>& effects) {
  std::vector<std::string> names;
  for (const EffectRules& effect : effects) names.push_back(effect.info().name);
  if (!names.empty()) ideal.title = fmt::format("{} with {}", ideal.title, fmt::join(names, ", "));
  if (any_drives(effects)) {
    ideal.state_names.emplace_back("phase");
    ideal.winding_names.emplace_back("n_phase");
  }
  return ideal;
}

Structure with_effects(Structure ideal, const std::vector<EffectRules>& effects, const Bound& bound) {
  Structure structure = std::move(ideal);
  const bool drives = any_drives(effects);
  const bool dissipates =
      std::any_of(effects.begin(), effects.end(), [](const EffectRules& effect) { return effect.dissipates; });
  const auto keep = [&](std::vector<Symmetry>& symmetries, bool reverse) {
    std::vector<Symmetry> kept;
    for (const Symmetry& symmetry : symmetries) {
      PhaseShift shift = PhaseShift::any;
      for (const EffectRules& effect : effects) shift = both(shift, effect.shift(symmetry, bound));
      if (shift == PhaseShift::broken) continue;
      kept.push_back(drives ? with_phase(symmetry, reverse, shift) : symmetry);
    }
    symmetries = std::move(kept);
  };
  if (dissipates) structure.reversors.clear();
  keep(structure.equivariances, false);
  keep(structure.reversors, true);
  structure.decays = dissipates && !drives && structure.conservative();
  if (dissipates || drives) structure.conserved.clear();
  structure.symplectic = structure.symplectic && !dissipates;
  structure.dissipative = structure.dissipative || dissipates;
  for (const EffectRules& effect : effects)
    if (effect.change != nullptr) effect.change(structure);
  if (drives) {
    structure.driven = true;
    structure.angles.push_back(structure.dimension);
    ++structure.dimension;
  }
  return structure;
}

bool mirrors(const Symmetry& ideal) { return ideal.map.matrix(0, 0) < 0.0; }

}  // namespace orbweaver::systems
