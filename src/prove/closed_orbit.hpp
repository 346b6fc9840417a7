#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ball.hpp"
#include "enclosed_flow.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/refine/exact_map.hpp"
#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::prove {

/// The equations whose only solution in a box is to be an orbit, as many as unknowns, in the scales: multiple shooting
/// on the fundamental domain, from instant to instant. Between two ends on the fixed sets of reversors R and g R; or,
/// without a reversor, from a section through the start, across the field, to its image under g.
class ClosedOrbit {
 public:
  /// `formulas` and `structure`: in the scales. `fractions`: the instants in parts of the period, from 0 to before the
  /// end of the domain. `start` and `end`: the states there, roughly; the section goes through `start`. `held`: in
  /// units. Throws core::InputError for symmetries that this cannot deal with.
  ClosedOrbit(const systems::Formulas& formulas, const systems::Structure& structure, const systems::Scales& scales,
              const loop::Isotropy& isotropy, const std::vector<double>& fractions, const refine::HeldValue& held,
              const BallVector& start, const BallVector& end);

  [[nodiscard]] std::size_t dimension() const { return static_cast<std::size_t>(_formulas.dimension); }
  [[nodiscard]] std::size_t segments() const { return _fractions.size(); }
  [[nodiscard]] std::size_t unknowns() const;
  [[nodiscard]] int order() const { return _order; }
  [[nodiscard]] bool mirrored() const { return _mirrored; }
  /// What isolates the orbit, in words.
  [[nodiscard]] const std::string& isolated_by() const { return _isolated_by; }
  [[nodiscard]] EnclosedFlow flow(double digits) const;

  /// All numbers of a candidate: the unknowns one after the other.
  [[nodiscard]] std::vector<BallVector> nodes(const BallVector& unknowns) const;
  [[nodiscard]] Ball period(const BallVector& unknowns) const;

  /// The exact unknowns of a candidate through the middle of `start`, its other nodes from integration, with `period`
  /// where that is not held.
  [[nodiscard]] BallVector candidate(EnclosedFlow& flow, const BallVector& start, const Ball& period) const;

  using Passage = std::vector<EnclosedFlow::Image>;  ///< one a segment
  [[nodiscard]] Passage pass(EnclosedFlow& flow, const BallVector& unknowns) const;
  [[nodiscard]] BallMatrix residual(const EnclosedFlow& flow, const BallVector& unknowns, const Passage& passage) const;
  /// Holds the Jacobians at all points of a box of unknowns.
  [[nodiscard]] BallMatrix jacobian(const EnclosedFlow& flow, const BallVector& unknowns, const Passage& passage) const;
  /// Throws NotProven unless a zero in the box is a closed orbit: without a reversor one closing equation is left out,
  /// and follows from the conserved quantity where that changes along its coordinate.
  void require_closes(const EnclosedFlow& flow, const BallVector& unknowns, const Passage& passage) const;

  /// mu + 1/mu of the fundamental map of orbits in the box; none in the plane.
  [[nodiscard]] std::optional<Ball> fundamental_index(const Passage& passage) const;

 private:
  /// offset + basis c, c being the coordinates `rows` of the state.
  struct FixedSet {
    BallMatrix basis;
    BallVector offset;
    std::vector<std::size_t> rows;
    [[nodiscard]] BallVector at(const BallVector& coordinates) const;
  };
  [[nodiscard]] FixedSet fixed_set(const BallMatrix& matrix, const BallVector& near) const;
  [[nodiscard]] std::vector<double> turns_between(const BallMatrix& matrix, const BallVector& from,
                                                  const BallVector& to) const;
  [[nodiscard]] Ball fraction(std::size_t node) const;
  [[nodiscard]] BallVector image_of_start(const BallVector& start) const;
  [[nodiscard]] std::size_t first_size() const { return _mirrored ? _start.rows.size() : dimension(); }
  /// Of the segments' ends but the last one's, where their nodes are unknowns.
  [[nodiscard]] std::size_t place(std::size_t node) const { return first_size() + dimension() * (node - 1); }
  [[nodiscard]] bool period_is_unknown() const { return _held.quantity == refine::HeldValue::Quantity::energy; }

  systems::Formulas _formulas;
  systems::Structure _structure;
  std::vector<double> _fractions;
  refine::HeldValue _held;
  Ball _held_value;  ///< in the scales
  BallVector _parameters;
  int _order = 1;
  bool _mirrored = false;
  BallMatrix _generator;
  BallMatrix _reversor;
  FixedSet _start;             ///< of R
  FixedSet _end;               ///< of g R
  std::vector<double> _turns;  ///< of g, without a reversor
  BallVector _section_point;
  BallVector _section_normal;
  std::size_t _left_out = 0;  ///< the closing equation that follows from the others
  std::string _isolated_by;
};

/// The entries as they are meant.
[[nodiscard]] BallMatrix enclosed(const refine::ExactMatrix& matrix, std::size_t size);

}  // namespace orbweaver::prove
