#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cell_counts.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "orbweaver/equations/orbit_solver.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"
#include "point_problem.hpp"

namespace orbweaver::continuation {

/// Points by collocation on the fundamental domain (equations::Collocation lays them out).
class CollocationProblem final : public PointProblem {
 public:
  /// Why this does not apply to a family, as the end of a sentence; empty where it does.
  [[nodiscard]] static std::string obstacle(const FamilyOf& family, int largest_cutoff);
  CollocationProblem(const FamilyOf& family, const Options& options, ProblemState& state);

  [[nodiscard]] Resolution resolution_for(int cutoff, const loop::TimeMap& map, int largest) const override;
  [[nodiscard]] std::optional<Resolution> next_resolution(int largest) const override;
  [[nodiscard]] std::optional<Resolution> finer(const Trial& trial, const std::vector<double>& settled,
                                                bool may_fit) override;
  [[nodiscard]] std::optional<Resolution> coarser(const Trial& accepted, const loop::Loop& loop, bool may_fit) override;
  Transfer resolve(const Resolution& to) override;
  void state_replaced() override { _equations.reset(); }
  [[nodiscard]] bool can_fit_cells() override { return equations().has_cells_to_fit(); }
  [[nodiscard]] bool is_preconditioned() const override { return true; }

  [[nodiscard]] std::vector<double> from_loop(const loop::Loop& loop) override;
  [[nodiscard]] std::vector<double> from_change(const loop::Loop& change) override;
  [[nodiscard]] std::size_t scalars_at() override { return static_cast<std::size_t>(equations().period_at()); }

  [[nodiscard]] double product(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c,
                               const std::vector<double>& d) override;
  [[nodiscard]] double distance(const std::vector<double>& a, const std::vector<double>& b) override;
  [[nodiscard]] double change_at_start(const std::vector<double>& change) override;
  [[nodiscard]] bool inverted(const Trial& trial, const std::vector<double>& last) override;
  [[nodiscard]] double action(const Trial& trial) override;

  void settle(Prediction& prediction, const std::vector<double>& last) override;
  [[nodiscard]] std::vector<double> conditions_at(const Prediction& prediction) override;
  [[nodiscard]] Trial solve(Prediction prediction, const std::vector<double>& conditions) override;
  [[nodiscard]] bool resolved(Trial& trial) override;
  [[nodiscard]] std::vector<double> direction_at(const std::vector<double>& orbit, const Prediction& near) override;
  [[nodiscard]] std::array<std::vector<double>, 2> surface_at(const std::vector<double>& orbit,
                                                              const Prediction& near) override;
  [[nodiscard]] loop::Tangent change_of(const std::vector<double>& direction, const loop::Loop& at) override;

 private:
  /// The equations of the state, with the factor that it names.
  equations::Collocation& equations();
  [[nodiscard]] std::shared_ptr<equations::Collocation> equations_on(const Resolution& resolution);
  /// The highest harmonic on a grid of `cells`.
  [[nodiscard]] int cutoff_of(int cells) const { return cell_counts::cutoff_of(_domain, cells); }
  [[nodiscard]] equations::AndersonSolver::Options solver_options();
  [[nodiscard]] double bounded_amplitude();
  [[nodiscard]] double rounding_of_nodes();
  [[nodiscard]] bool may_be_sharper(Trial& trial);
  [[nodiscard]] std::optional<Trial> solved_anew(const equations::AndersonSolver::Options& options,
                                                 const std::vector<double>& conditions, Trial trial);
  [[nodiscard]] bool sharpen_with(const equations::AndersonSolver::Options& options,
                                  const std::vector<double>& conditions, Trial& trial);
  [[nodiscard]] equations::Preconditioner preconditioner_of(const equations::Collocation& equations);
  void sharpen(Trial& trial, double last_change, const std::vector<double>& conditions);
  [[nodiscard]] bool rests_aside(const Trial& trial);
  void solve_by_gmres(Trial& trial, bool has_new_factor, const std::vector<double>& predicted,
                      const std::vector<double>& conditions);
  [[nodiscard]] double period_unit(double period);
  [[nodiscard]] std::optional<Resolution> remapped(const Trial& of, const std::vector<double>& settled);

  const systems::System& _system;
  loop::FundamentalDomain _domain;
  loop::Isotropy _isotropy;
  std::vector<double> _centre;
  std::vector<double> _winding;
  const Options& _options;
  std::shared_ptr<equations::Collocation> _equations;
  equations::OrbitSolver _solver;
};

}  // namespace orbweaver::continuation
