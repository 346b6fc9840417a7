#include "linear_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/undeclared_symmetries.hpp"
#include "trial_states.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Relative to the terms that cancel: rounding leaves some 1e-15.
constexpr double to_rounding = 1e-10;
/// Of the largest determinant: among coordinates that will do, the first.
constexpr double as_good = 0.1;
constexpr std::size_t most_choices = 64;

struct Trial {
  std::vector<double> state;
  VectorXd field;
  MatrixXd jacobian;
  MatrixXd gradients;  // of all conserved quantities
};

std::vector<int> first_numbers(std::size_t count) {
  std::vector<int> numbers(count);
  for (std::size_t n = 0; n < count; ++n) numbers[n] = static_cast<int>(n);
  return numbers;
}

std::vector<Trial> trials_of(const System& system) {
  const Index d = system.dimension();
  const std::vector<std::vector<double>> origin{std::vector<double>(static_cast<std::size_t>(d), 0.0)};
  std::vector<Trial> trials;
  for (const double size : trial_sizes)
    for (const std::vector<double>& state : states_around(system.structure(), origin, states_a_size, size)) {
      Trial trial{state, VectorXd(d), MatrixXd(d, d), {}};
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(d, d);
      system.field_jacobian(1, state.data(), trial.field.data(), jacobian.data());
      trial.jacobian = jacobian;
      trial.gradients = gradients_of(system, first_numbers(system.structure().conserved.size()), state);
      if (trial.field.allFinite() && trial.jacobian.allFinite() && trial.gradients.allFinite())
        trials.push_back(std::move(trial));
    }
  return trials;
}

/// True where a . b vanishes to rounding, whatever the sizes of its terms.
bool cancels(const VectorXd& a, const VectorXd& b, double to) {
  const VectorXd terms = a.cwiseProduct(b);
  return std::abs(terms.sum()) <= to * terms.cwiseAbs().sum();
}

bool is_constant(const std::vector<Trial>& trials, Index quantity) {
  const VectorXd first = trials.front().gradients.col(quantity);
  return std::all_of(trials.begin(), trials.end(), [&](const Trial& trial) {
    return (trial.gradients.col(quantity) - first).cwiseAbs().maxCoeff() <= to_rounding * first.cwiseAbs().maxCoeff();
  });
}

/// A basis of what all Jacobians map to 0.
MatrixXd common_kernel(const std::vector<Trial>& trials) {
  const Index d = trials.front().field.size();
  MatrixXd all(d * static_cast<Index>(trials.size()), d);
  for (std::size_t n = 0; n < trials.size(); ++n) all.middleRows(d * static_cast<Index>(n), d) = trials[n].jacobian;
  VectorXd scales = VectorXd::Ones(d);
  for (int sweep = 0; sweep < balancing_sweeps; ++sweep) {
    for (Index i = 0; i < all.rows(); ++i)
      if (const double size = all.row(i).cwiseAbs().maxCoeff(); size > 0.0) all.row(i) /= size;
    for (Index l = 0; l < d; ++l)
      if (const double size = all.col(l).cwiseAbs().maxCoeff(); size > 0.0) {
        all.col(l) /= size;
        scales(l) /= size;
      }
  }
  Eigen::ColPivHouseholderQR<MatrixXd> qr(all);
  qr.setThreshold(to_rounding);
  const Index rank = qr.rank();
  MatrixXd kernel = MatrixXd::Zero(d, d - rank);
  kernel.bottomRows(d - rank).setIdentity();
  kernel.topRows(rank) = -qr.matrixR()
                              .topLeftCorner(rank, rank)
                              .triangularView<Eigen::Upper>()
                              .solve(qr.matrixR().topRightCorner(rank, d - rank).eval());
  return scales.asDiagonal() * (qr.colsPermutation() * kernel);
}

/// Calls `take` with each choice of `count` of the candidates, in their order, until it returns true.
bool find_choice(const std::vector<int>& candidates, std::size_t count,
                 const std::function<bool(const std::vector<int>&)>& take) {
  std::vector<int> chosen;
  const std::function<bool(std::size_t)> more = [&](std::size_t from) {
    if (chosen.size() == count) return take(chosen);
    for (std::size_t n = from; n < candidates.size(); ++n) {
      chosen.push_back(candidates[n]);
      if (more(n + 1)) return true;
      chosen.pop_back();
    }
    return false;
  };
  return more(0);
}

/// The motions that bring `frame` to 0, if their entries are whole numbers, and an angle moves angles only.
std::optional<MatrixXd> motions_of(const MatrixXd& kernel, const std::vector<int>& frame, const Structure& structure) {
  const Eigen::PartialPivLU<MatrixXd> square(rows_of(kernel, frame));
  if (square.determinant() == 0.0) return std::nullopt;
  MatrixXd motions = kernel * square.inverse();
  if (!motions.allFinite()) return std::nullopt;
  const MatrixXd whole = motions.array().round();
  if ((motions - whole).cwiseAbs().maxCoeff() > half_the_digits) return std::nullopt;
  for (Index a = 0; a < whole.cols(); ++a)
    for (Index i = 0; i < whole.rows(); ++i)
      if (whole(i, a) != 0.0 && structure.is_angle(static_cast<std::size_t>(frame[static_cast<std::size_t>(a)])) &&
          !structure.is_angle(static_cast<std::size_t>(i)))
        return std::nullopt;
  return whole;
}

class Search {
 public:
  explicit Search(const System& system)
      : _system(system), _names(system.structure().conserved), _trials(trials_of(system)) {}

  /// Throws no exception: returns what stands in the way.
  std::string run(LinearSearch& search) {
    LinearQuantities& found = search.found;
    const Structure& structure = _system.structure();
    if (_trials.empty()) return "its field is not finite at any state that was tried";
    found.place = _trials.front().state;
    for (std::size_t k = 0; k < _names.size(); ++k)
      if (is_constant(_trials, static_cast<Index>(k))) found.quantities.push_back(static_cast<int>(k));
    if (found.quantities.empty())
      return fmt::format("none of {} is linear in the coordinates", fmt::join(_names, ", "));
    if (found.quantities.size() == _names.size()) return "all of them are linear in the coordinates: none is an energy";
    const auto count = static_cast<Index>(found.quantities.size());
    if (structure.dimension < 2 * count + 2) return "nothing would be left";
    const MatrixXd gradients = gradients_of(_system, found.quantities, found.place);
    for (Index a = 0; a < count; ++a) {
      for (const Trial& trial : _trials)
        if (!cancels(gradients.col(a), trial.field, half_the_digits))
          return fmt::format("{} changes along the field", name(found, a));
      for (const int angle : structure.angles)
        if (gradients(angle, a) != 0.0) return fmt::format("{} has not the period of an angle", name(found, a));
    }
    return frame(search, gradients);
  }

 private:
  [[nodiscard]] const std::string& name(const LinearQuantities& found, Index a) const {
    return _names[static_cast<std::size_t>(found.quantities[static_cast<std::size_t>(a)])];
  }

  std::string frame(LinearSearch& search, const MatrixXd& gradients) {
    LinearQuantities& found = search.found;
    const Structure& structure = _system.structure();
    const std::size_t count = found.quantities.size();
    const MatrixXd kernel = common_kernel(_trials);
    if (kernel.cols() != static_cast<Index>(count))
      return fmt::format(
          "its field stays the same along {} translation{} of the coordinates, and {} of its conserved "
          "quantities {} linear in them, where each belongs to one",
          kernel.cols(), kernel.cols() == 1 ? "" : "s", count, count == 1 ? "is" : "are");
    std::vector<int> candidates;
    for (const bool angles : {false, true})
      for (int i = 0; i < structure.dimension; ++i)
        if (structure.is_angle(static_cast<std::size_t>(i)) == angles && !kernel.row(i).isZero(0.0))
          candidates.push_back(i);
    static_cast<void>(find_choice(candidates, count, [&](const std::vector<int>& chosen) {
      const auto motions = motions_of(kernel, chosen, structure);
      if (motions && belong(*motions)) {
        search.frames.push_back(found);
        search.frames.back().motions = *motions;
        search.frames.back().frame = chosen;
      }
      return search.frames.size() == most_choices;
    }));
    if (search.frames.empty())
      return "its translations move the coordinates by amounts that are not whole multiples of one another";
    found = search.frames.front();
    for (Index a = 0; a < gradients.cols(); ++a)
      for (Index b = 0; b < gradients.cols(); ++b)
        if (!cancels(gradients.col(a), found.motions.col(b), to_rounding))
          return fmt::format("{} changes along the translations that keep the field", name(found, a));
    return redundant(search, gradients);
  }

  /// The field and all conserved quantities stay the same along the motions.
  [[nodiscard]] bool belong(const MatrixXd& motions) const {
    for (const Trial& trial : _trials)
      for (Index a = 0; a < motions.cols(); ++a) {
        for (Index i = 0; i < trial.jacobian.rows(); ++i)
          if (!cancels(trial.jacobian.row(i).transpose(), motions.col(a), half_the_digits)) return false;
        for (Index k = 0; k < trial.gradients.cols(); ++k)
          if (!cancels(trial.gradients.col(k), motions.col(a), half_the_digits)) return false;
      }
    return true;
  }

  std::string redundant(LinearSearch& search, const MatrixXd& gradients) {
    const LinearQuantities& found = search.found;
    std::vector<int> candidates;
    for (int i = 0; i < _system.dimension(); ++i)
      if (std::find(found.frame.begin(), found.frame.end(), i) == found.frame.end() && !gradients.row(i).isZero(0.0))
        candidates.push_back(i);
    const auto size = [&](const std::vector<int>& chosen) {
      return std::abs(Eigen::PartialPivLU<MatrixXd>(rows_of(gradients, chosen)).determinant());
    };
    double largest = 0.0;
    static_cast<void>(find_choice(candidates, found.quantities.size(), [&](const std::vector<int>& chosen) {
      largest = std::max(largest, size(chosen));
      return false;
    }));
    if (largest == 0.0) return "their values leave no coordinate redundant";
    static_cast<void>(find_choice(candidates, found.quantities.size(), [&](const std::vector<int>& chosen) {
      if (size(chosen) >= as_good * largest) search.redundants.push_back(chosen);
      return search.redundants.size() == most_choices;
    }));
    search.found.redundant = search.redundants.front();
    for (LinearQuantities& frame : search.frames) frame.redundant = search.redundants.front();
    return "";
  }

  const System& _system;
  const std::vector<std::string>& _names;
  std::vector<Trial> _trials;
};

}  // namespace

LinearSearch find_linear_quantities(const System& system) {
  LinearSearch search;
  if (dynamic_cast<const FormulaSystem*>(&system) == nullptr)
    search.obstacle = "it does not give its formulas";
  else
    search.obstacle = Search(system).run(search);
  return search;
}

std::vector<std::string> undeclared_translations(const System& system) {
  const Structure& structure = system.structure();
  if (!structure.symplectic || structure.driven || structure.conserved.size() != 1) return {};
  const std::vector<Trial> trials = trials_of(system);
  if (trials.empty()) return {};
  const MatrixXd kernel = common_kernel(trials);
  std::vector<std::string> moved;
  for (Index i = 0; i < kernel.rows(); ++i)
    if (kernel.cols() > 0 && kernel.row(i).cwiseAbs().maxCoeff() > half_the_digits * kernel.cwiseAbs().maxCoeff())
      moved.push_back(system.info().state_names[static_cast<std::size_t>(i)]);
  return moved;
}

MatrixXd rows_of(const MatrixXd& matrix, const std::vector<int>& rows) {
  MatrixXd out(static_cast<Index>(rows.size()), matrix.cols());
  for (std::size_t n = 0; n < rows.size(); ++n) out.row(static_cast<Index>(n)) = matrix.row(rows[n]);
  return out;
}

MatrixXd gradients_of(const System& system, const std::vector<int>& quantities, const std::vector<double>& place) {
  MatrixXd gradients(system.dimension(), static_cast<Index>(quantities.size()));
  for (std::size_t n = 0; n < quantities.size(); ++n)
    system.conserved_gradient(quantities[n], place, {gradients.col(static_cast<Index>(n)).data(), place.size()});
  return gradients;
}

}  // namespace orbweaver::systems
