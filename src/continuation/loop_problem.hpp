#pragma once

#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "point_problem.hpp"

namespace orbweaver::continuation {

/// Points as whole loops in the subspace of an isotropy, by any corrector, on a team of ranks too: the modes, then T,
/// the parameters that move.
/// The time map is that of the base, a resolution's size the cutoff.
class LoopProblem final : public PointProblem {
 public:
  LoopProblem(const FamilyOf& family, const Options& options, ProblemState& state);

  [[nodiscard]] Resolution resolution_for(int cutoff, const loop::TimeMap& map, int largest) const override;
  [[nodiscard]] std::optional<Resolution> next_resolution(int largest) const override;
  [[nodiscard]] std::optional<Resolution> finer(const Trial& trial, const std::vector<double>& settled,
                                                bool may_fit) override;
  [[nodiscard]] std::optional<Resolution> coarser(const Trial& accepted, const loop::Loop& loop, bool may_fit) override;
  Transfer resolve(const Resolution& to) override;

  [[nodiscard]] std::vector<double> from_loop(const loop::Loop& loop) override;
  [[nodiscard]] std::vector<double> from_change(const loop::Loop& change) override;
  [[nodiscard]] loop::Tangent change_of(const std::vector<double>& direction, const loop::Loop& at) override;
  [[nodiscard]] std::size_t scalars_at() override;

  [[nodiscard]] double product(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c,
                               const std::vector<double>& d) override;
  [[nodiscard]] double condition_product(const std::vector<double>& a, const std::vector<double>& b,
                                         const std::vector<double>& c, const std::vector<double>& d) override;
  [[nodiscard]] double distance(const std::vector<double>& a, const std::vector<double>& b) override;
  [[nodiscard]] double change_at_start(const std::vector<double>& change) override;
  [[nodiscard]] bool inverted(const Trial& trial, const std::vector<double>& last) override;
  [[nodiscard]] double action(const Trial& trial) override;

  void settle(Prediction& prediction, const std::vector<double>& last) override;
  [[nodiscard]] std::vector<double> conditions_at(const Prediction& prediction) override;
  [[nodiscard]] Trial solve(Prediction prediction, const std::vector<double>& conditions) override;
  [[nodiscard]] bool resolved(Trial& trial) override;
  [[nodiscard]] std::vector<double> direction_at(const std::vector<double>& orbit, const Prediction& near) override;

 private:
  /// T and the parameters that move.
  [[nodiscard]] std::size_t scalars() const { return 1 + _system.family_scalars().free.size(); }
  [[nodiscard]] loop::Tangent as_tangent(std::span<const double> change) const;
  [[nodiscard]] loop::Loop to_loop(const std::vector<double>& values) const;
  [[nodiscard]] std::vector<double> to_values(const loop::Loop& loop) const;
  [[nodiscard]] const loss::Unknowns& unknowns();
  /// Rows of conditions on points as columns of conditions on the unknowns.
  [[nodiscard]] Eigen::MatrixXd columns(const std::vector<double>& conditions);
  /// The condition of what the family holds, as a row; empty where it holds nothing.
  [[nodiscard]] std::vector<double> held_condition(const Prediction& prediction);
  /// The unit time shift of a point that the symmetries leave free; empty where there is none.
  [[nodiscard]] loop::Loop with_symmetries(const loop::Loop& loop);
  [[nodiscard]] std::vector<double> time_shift(const std::vector<double>& values);

  const systems::System& _system;
  loop::Loop _base;
  loop::Isotropy _isotropy;
  const Options& _options;
  std::optional<loss::Unknowns> _unknowns;  // of the present cutoff
};

/// The unit direction of a time shift of `loop`, the phase condition of loops without a reversor (paper, section II
/// B); empty where the unknowns do not contain it.
[[nodiscard]] std::vector<double> time_shift_condition(const loop::Loop& loop, const loss::Unknowns& unknowns);

}  // namespace orbweaver::continuation
