#include "reduced_structure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double same_entries = 1e-10;
/// Entries of reduced maps are sums of products of whole ones.
constexpr double to_whole_numbers = 1e-12;
constexpr int most_parts_of_a_ratio = 1000;
constexpr double largest_numerator = 1e6;

bool holds_number(const std::vector<int>& list, std::size_t number) {
  return std::find(list.begin(), list.end(), static_cast<int>(number)) != list.end();
}

bool is_zero(const MatrixXd& off, const MatrixXd& beside) {
  return off.cwiseAbs().maxCoeff() <= same_entries * std::max(1.0, beside.cwiseAbs().maxCoeff());
}

/// Maps of the whole system, and what they are on the reduced one.
class Descent {
 public:
  Descent(const System& whole, const LinearQuantities& linear, const Chart& chart) : _linear(linear), _chart(chart) {
    for (const int quantity : linear.quantities) {
      const auto& free = whole.family_scalars().free;
      const std::string& name = whole.structure().conserved[static_cast<std::size_t>(quantity)];
      _moves = _moves || std::find(free.begin(), free.end(), name) != free.end();
    }
  }

  [[nodiscard]] std::optional<AffineMap> operator()(const AffineMap& map) const {
    if (const MatrixXd moved = map.matrix * _linear.motions;
        moved.cols() > 0 && !is_zero(moved - _linear.motions * rows_of(moved, _linear.frame), moved))
      return std::nullopt;
    const MatrixXd& w = _chart.gradients;
    const MatrixXd pulled = map.matrix.transpose() * w;
    const MatrixXd mixed = _chart.from_values.transpose() * rows_of(pulled, _linear.redundant);  // transposed
    if (!is_zero(pulled - w * mixed, pulled)) return std::nullopt;
    // Q(g z) - constant = mixed^T (Q(z) - constant) + w^T offset.
    const VectorXd shift = w.transpose() * map.offset;
    const Index k = shift.size();
    if (_moves && (!is_zero(mixed - MatrixXd::Identity(k, k), mixed) || !is_zero(shift, w))) return std::nullopt;
    const VectorXd image = mixed.transpose() * (_chart.values - _chart.constants) + shift + _chart.constants;
    const double size =
        _chart.values.cwiseAbs().maxCoeff() + _chart.constants.cwiseAbs().maxCoeff() + shift.cwiseAbs().maxCoeff();
    if ((image - _chart.values).cwiseAbs().maxCoeff() > same_entries * size) return std::nullopt;
    const auto told = [](double entry) {
      const double whole = std::round(entry);
      return std::abs(entry - whole) <= to_whole_numbers ? whole : entry;
    };
    const MatrixXd matrix = (_chart.rates * map.matrix * _chart.states).unaryExpr(told);
    return AffineMap(matrix, _chart.rates * (map.matrix * _chart.origin + map.offset));
  }

 private:
  const LinearQuantities& _linear;
  const Chart& _chart;
  bool _moves = false;
};

/// The ratio of the smallest denominator that a number is to rounding.
std::optional<Ratio> ratio_of(double number) {
  for (int n = 1; n <= most_parts_of_a_ratio; ++n) {
    const double parts = number * n;
    if (std::abs(parts) < largest_numerator && std::abs(parts - std::round(parts)) <= to_whole_numbers * n)
      return Ratio{static_cast<int>(std::lround(parts)), n};
  }
  return std::nullopt;
}

MatrixXd matrix_of(const Straightening& straightening) {
  const auto n = static_cast<Index>(straightening.squares.size());
  MatrixXd matrix(n, n);
  const auto value = [](const Ratio& ratio) { return static_cast<double>(ratio.numerator) / ratio.denominator; };
  for (std::size_t i = 0; i < straightening.squares.size(); ++i)
    for (std::size_t l = 0; l < straightening.squares.size(); ++l)
      matrix(static_cast<Index>(i), static_cast<Index>(l)) =
          std::sqrt(value(straightening.squares[i])) * value(straightening.unit[i][l]);
  return matrix;
}

MatrixXd off_orthogonal(const MatrixXd& matrix) {
  return matrix * matrix.transpose() - MatrixXd::Identity(matrix.rows(), matrix.rows());
}

bool is_orthogonal(const MatrixXd& matrix) { return off_orthogonal(matrix).cwiseAbs().maxCoeff() <= same_entries; }

bool is_skew(const AffineMap& whole, const AffineMap& reduced) {
  return is_orthogonal(whole.matrix) && !is_orthogonal(reduced.matrix);
}

struct Declared {
  Symmetry symmetry;
  bool reverses;
};

}  // namespace

Chart chart_of(const System& whole, const LinearQuantities& linear, const std::optional<Straightening>& straightening) {
  const auto d = static_cast<std::size_t>(whole.dimension());
  const auto k = static_cast<Index>(linear.quantities.size());
  Chart chart;
  for (std::size_t i = 0; i < d; ++i)
    if (!holds_number(linear.frame, i) && !holds_number(linear.redundant, i)) chart.kept.push_back(i);
  const std::vector<std::string>& names = whole.structure().conserved;
  for (std::size_t q = 0; q < names.size(); ++q)
    if (!holds_number(linear.quantities, q)) chart.others.push_back(static_cast<int>(q));
  chart.gradients = gradients_of(whole, linear.quantities, linear.place);
  chart.from_values = rows_of(chart.gradients, linear.redundant).transpose().inverse();
  core::require(chart.from_values.allFinite(), "the redundant coordinates do not follow from the quantities");
  chart.values.resize(k);
  chart.constants.resize(k);
  const VectorXd place = Eigen::Map<const VectorXd>(linear.place.data(), static_cast<Index>(d));
  for (Index a = 0; a < k; ++a) {
    const int quantity = linear.quantities[static_cast<std::size_t>(a)];
    const auto held = whole.parameters().find(names[static_cast<std::size_t>(quantity)]);
    chart.values(a) = held == whole.parameters().end() ? 0.0 : held->second;
    chart.constants(a) = whole.conserved(quantity, linear.place) - chart.gradients.col(a).dot(place);
    if (std::abs(chart.constants(a)) <= same_entries * chart.gradients.col(a).cwiseAbs().dot(place.cwiseAbs()))
      chart.constants(a) = 0.0;
  }
  const auto n = static_cast<Index>(chart.kept.size());
  chart.states = MatrixXd::Zero(static_cast<Index>(d), n);
  chart.rates = MatrixXd::Zero(n, static_cast<Index>(d));
  chart.origin = VectorXd::Zero(static_cast<Index>(d));
  MatrixXd kept_gradients(n, k);
  for (Index c = 0; c < n; ++c) {
    const auto i = static_cast<Index>(chart.kept[static_cast<std::size_t>(c)]);
    chart.states(i, c) = 1.0;
    chart.rates(c, i) = 1.0;
    for (std::size_t a = 0; a < linear.frame.size(); ++a)
      chart.rates(c, linear.frame[a]) = -linear.motions(i, static_cast<Index>(a));
    kept_gradients.row(c) = chart.gradients.row(i);
  }
  const MatrixXd follows = -chart.from_values * kept_gradients.transpose();
  const VectorXd origin = chart.from_values * (chart.values - chart.constants);
  for (Index e = 0; e < k; ++e) {
    const int i = linear.redundant[static_cast<std::size_t>(e)];
    chart.states.row(i) = follows.row(e);
    chart.origin(i) = origin(e);
  }
  chart.straightening = straightening;
  if (straightening) {
    const MatrixXd s = matrix_of(*straightening);
    chart.rates = s * chart.rates;
    chart.states = chart.states * s.inverse();
  }
  return chart;
}

double skewness(const System& whole, const LinearQuantities& linear, const Chart& chart) {
  const Descent descend(whole, linear, chart);
  double sum = 0.0;
  for (const auto* symmetries : {&whole.structure().equivariances, &whole.structure().reversors})
    for (const Symmetry& symmetry : *symmetries) {
      const std::optional<AffineMap> map = descend(symmetry.map);
      if (map && is_skew(symmetry.map, *map)) sum += off_orthogonal(map->matrix).norm();
    }
  return sum;
}

std::optional<Straightening> straightening_of(const System& whole, const LinearQuantities& linear, const Chart& chart) {
  const Structure& structure = whole.structure();
  // Of the whole length, what motions and quantities leave.
  MatrixXd gone(structure.dimension, linear.motions.cols() + chart.gradients.cols());
  gone << linear.motions, chart.gradients;
  const MatrixXd basis =
      Eigen::HouseholderQR<MatrixXd>(gone).householderQ() * MatrixXd::Identity(structure.dimension, gone.cols());
  const MatrixXd across = chart.states - basis * (basis.transpose() * chart.states);
  MatrixXd rest = across.transpose() * across;  // = unit^T diag(squares) unit, by elimination
  const Index n = rest.rows();
  Straightening out;
  for (Index i = 0; i < n; ++i) {
    std::vector<Ratio>& row = out.unit.emplace_back();
    const double square = rest(i, i);
    for (Index l = 0; l < n; ++l) {
      const std::optional<Ratio> entry = ratio_of(l < i ? 0.0 : rest(i, l) / square);
      const bool is_own = structure.is_angle(chart.kept[static_cast<std::size_t>(i)]) ||
                          structure.is_angle(chart.kept[static_cast<std::size_t>(l)]);
      if (!entry || (l != i && entry->numerator != 0 && is_own)) return std::nullopt;
      row.push_back(*entry);
    }
    const bool is_angle = structure.is_angle(chart.kept[static_cast<std::size_t>(i)]);
    const std::optional<Ratio> ratio = is_angle ? Ratio{1, 1} : ratio_of(square);
    if (!ratio || ratio->numerator <= 0) return std::nullopt;
    out.squares.push_back(*ratio);
    const VectorXd eliminated = rest.row(i).transpose() / square;
    rest -= square * eliminated * eliminated.transpose();
  }
  return out;
}

Structure reduced_structure(const System& whole, const LinearQuantities& linear, const Chart& chart) {
  const Structure& from = whole.structure();
  const Descent descend(whole, linear, chart);
  Structure to;
  to.dimension = static_cast<int>(chart.kept.size());
  for (std::size_t c = 0; c < chart.kept.size(); ++c)
    if (from.is_angle(chart.kept[c])) to.angles.push_back(static_cast<int>(c));
  for (const int quantity : chart.others) to.conserved.push_back(from.conserved[static_cast<std::size_t>(quantity)]);
  to.guards = from.guards;
  to.symplectic = from.symplectic;
  to.dissipative = from.dissipative;
  to.driven = from.driven;
  to.decays = from.decays;

  std::set<std::string> names{"1"};
  std::vector<Declared> left;
  const auto take = [&](const Declared& declared) {
    const std::optional<AffineMap> map = descend(declared.symmetry.map);
    if (!map) return false;
    if (is_skew(declared.symmetry.map, *map)) return true;
    std::vector<Symmetry>& list = declared.reverses ? to.reversors : to.equivariances;
    const auto is_it = [&](const AffineMap& other) { return other.is_same(*map, to.angles); };
    if ((!declared.reverses && is_it(AffineMap::identity(to.dimension))) ||
        std::any_of(list.begin(), list.end(), [&](const Symmetry& known) { return is_it(known.map); }))
      return true;
    std::string name = declared.symmetry.name;
    while (!names.insert(name).second) name += "'";
    list.push_back({name, *map});
    return true;
  };
  for (const bool reverses : {false, true})
    for (const Symmetry& symmetry : reverses ? from.reversors : from.equivariances)
      if (!take({symmetry, reverses})) left.push_back({symmetry, reverses});
  for (const Declared& a : left)
    for (const Declared& b : left)
      static_cast<void>(
          take({{a.symmetry.name + b.symmetry.name, a.symmetry.map * b.symmetry.map}, a.reverses != b.reverses}));
  return to;
}

ModelInfo reduced_info(const System& whole, const LinearQuantities& linear, const Chart& chart) {
  ModelInfo info = whole.info();
  const std::vector<std::string> names = info.state_names;
  const std::vector<std::string> windings = info.winding_names;
  info.state_names.clear();
  info.winding_names.clear();
  std::vector<std::string> told;
  for (std::size_t c = 0; c < chart.kept.size(); ++c) {
    info.state_names.push_back(names[chart.kept[c]]);
    info.winding_names.push_back(windings[chart.kept[c]]);
    const auto row = static_cast<Index>(c);
    const bool is_alone = (chart.rates.row(row).array() != 0.0).count() == 1;
    if (is_alone && chart.rates(row, static_cast<Index>(chart.kept[c])) == 1.0) continue;  // told as it is
    if (chart.straightening) info.state_names.back() += "_rel";
    std::string sum;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double factor = chart.rates(row, static_cast<Index>(i));
      if (factor == 0.0) continue;
      const std::string size = std::abs(factor) == 1.0 ? "" : fmt::format("{:.6g} ", std::abs(factor));
      const std::string sign = sum.empty() ? (factor < 0.0 ? "-" : "") : (factor < 0.0 ? " - " : " + ");
      sum += sign + size + names[i];
    }
    told.push_back(fmt::format("{} for {}", info.state_names.back(), sum));
  }
  std::vector<std::string> held, frame, redundant;
  for (std::size_t a = 0; a < linear.quantities.size(); ++a) {
    held.push_back(fmt::format("{} = {:g}", whole.structure().conserved[static_cast<std::size_t>(linear.quantities[a])],
                               chart.values(static_cast<Index>(a))));
    redundant.push_back(names[static_cast<std::size_t>(linear.redundant[a])]);
  }
  for (const int left_out : linear.frame) frame.push_back(names[static_cast<std::size_t>(left_out)]);
  info.meaning += fmt::format("; held: {}, from which {} follow{}", fmt::join(held, ", "), fmt::join(redundant, ", "),
                              redundant.size() == 1 ? "s" : "");
  if (frame.empty() && told.empty()) return info;
  if (frame.empty()) frame = redundant;
  info.meaning += told.empty() ? fmt::format("; {} left out", fmt::join(frame, ", "))
                               : fmt::format("; {} left out: {}", fmt::join(frame, ", "), fmt::join(told, ", "));
  return info;
}

}  // namespace orbweaver::systems
