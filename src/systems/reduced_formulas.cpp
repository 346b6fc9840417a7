#include "reduced_formulas.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/recorded.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::systems {

namespace {

using model::Recorded;
using Numbers = std::vector<Recorded>;

/// The rows of a square matrix in the order in which elimination in double precision takes them.
std::vector<std::size_t> pivot_rows(const Eigen::MatrixXd& square) {
  const Eigen::PartialPivLU<Eigen::MatrixXd> elimination(square);
  std::vector<std::size_t> rows(static_cast<std::size_t>(square.rows()));
  for (Eigen::Index a = 0; a < square.rows(); ++a)
    rows[static_cast<std::size_t>(elimination.permutationP().indices()(a))] = static_cast<std::size_t>(a);
  return rows;
}

/// The solution of left x = right.
Numbers solved(std::vector<Numbers> left, Numbers right, const std::vector<std::size_t>& rows) {
  const std::size_t k = rows.size();
  for (std::size_t a = 0; a < k; ++a)
    for (std::size_t b = a + 1; b < k; ++b) {
      const Recorded factor = left[rows[b]][a] / left[rows[a]][a];
      for (std::size_t e = a; e < k; ++e) left[rows[b]][e] -= factor * left[rows[a]][e];
      right[rows[b]] -= factor * right[rows[a]];
    }
  Numbers x(k, Recorded(0.0));
  for (std::size_t a = k; a-- > 0;) {
    Recorded sum = right[rows[a]];
    for (std::size_t e = a + 1; e < k; ++e) sum -= left[rows[a]][e] * x[e];
    x[a] = sum / left[rows[a]][a];
  }
  return x;
}

/// While it is built, and used, all Recorded numbers are in one graph.
class Reduction {
 public:
  Reduction(const System& whole, const Formulas& plain, const LinearQuantities& linear, const Chart& chart)
      : _plain(plain),
        _linear(linear),
        _chart(chart),
        _n(chart.kept.size()),
        _d(static_cast<std::size_t>(chart.states.rows())) {
    for (std::size_t p = 0; p < plain.parameters.size(); ++p)
      _parameters.push_back(_recording.parameter(static_cast<int>(p)));
    _inputs.assign(_d * (1 + _d), Recorded(0.0));
    Numbers y;
    for (std::size_t c = 0; c < _n; ++c) y.push_back(_recording.input(static_cast<int>(c)));
    const Numbers x = in_frame(y);
    for (std::size_t c = 0; c < _n; ++c) _inputs[chart.kept[c]] = x[c];
    solve_for_redundant(whole);
    for (std::size_t column = 0; column < _n; ++column) {
      Numbers direction;
      for (std::size_t c = 0; c < _n; ++c)
        direction.push_back(_recording.input(static_cast<int>(_n + c * _n + column)));
      const Numbers moved = in_frame(direction);
      for (std::size_t c = 0; c < _n; ++c) {
        _inputs[_d + chart.kept[c] * _d + column] = moved[c];
        for (std::size_t e = 0; e < quantities(); ++e)
          _inputs[_d + redundant(e) * _d + column] += _follows[c][e] * moved[c];
      }
    }
  }

  [[nodiscard]] Formulas formulas() {
    Formulas out = _plain;
    out.dimension = static_cast<int>(_n);
    const Numbers field = nodes_of(_plain.field);
    const Numbers variations = nodes_of(_plain.variations);
    out.field.clear();
    out.variations.clear();
    for (const Recorded& rate : rates([&](std::size_t i) { return field[i]; })) out.field.push_back(rate.node());
    out.variations.resize(_n * _n);
    for (std::size_t c = 0; c < _n; ++c) {
      const Numbers column = rates([&](std::size_t i) { return variations[i * _d + c]; });
      for (std::size_t r = 0; r < _n; ++r) out.variations[r * _n + c] = column[r].node();
    }
    out.conserved.clear();
    out.conserved_gradients.clear();
    for (const int other : _chart.others) {
      const auto q = static_cast<std::size_t>(other);
      out.conserved.push_back(nodes_of({_plain.conserved[q]}).front().node());
      const Numbers slopes = nodes_of(_plain.conserved_gradients[q]);
      Numbers by_frame;
      for (std::size_t c = 0; c < _n; ++c) {
        Recorded sum = slopes[_chart.kept[c]];
        for (std::size_t e = 0; e < quantities(); ++e) sum += slopes[redundant(e)] * _follows[c][e];
        by_frame.push_back(sum);
      }
      std::vector<int>& gradient = out.conserved_gradients.emplace_back();
      for (const Recorded& slope : straightened_gradient(by_frame)) gradient.push_back(slope.node());
    }
    out.graph = _recording.graph();
    return out;
  }

 private:
  [[nodiscard]] std::size_t quantities() const { return _linear.quantities.size(); }
  [[nodiscard]] std::size_t redundant(std::size_t e) const { return static_cast<std::size_t>(_linear.redundant[e]); }

  [[nodiscard]] Numbers nodes_of(const std::vector<int>& nodes) const {
    return model::evaluate<Recorded>(_plain.graph, nodes, _inputs, _parameters);
  }

  /// With those at 0 the quantities lack what they are to make up for.
  void solve_for_redundant(const System& whole) {
    std::vector<Numbers> gradients, square;
    Numbers missing;
    for (const int quantity : _linear.quantities) {
      const auto q = static_cast<std::size_t>(quantity);
      gradients.push_back(nodes_of(_plain.conserved_gradients[q]));
      const std::string& name = whole.structure().conserved[q];
      const auto held = std::find(_plain.parameters.begin(), _plain.parameters.end(), name);
      const Recorded value = held == _plain.parameters.end()
                                 ? Recorded(0.0)
                                 : _parameters[static_cast<std::size_t>(held - _plain.parameters.begin())];
      missing.push_back(value - nodes_of({_plain.conserved[q]}).front());
      Numbers& row = square.emplace_back();
      for (std::size_t e = 0; e < quantities(); ++e) row.push_back(gradients.back()[redundant(e)]);
    }
    const std::vector<std::size_t> rows = pivot_rows(rows_of(_chart.gradients, _linear.redundant).transpose());
    for (std::size_t c = 0; c < _n; ++c) {
      Numbers right;
      for (const Numbers& gradient : gradients) right.push_back(-gradient[_chart.kept[c]]);
      _follows.push_back(solved(square, right, rows));
    }
    const Numbers values = solved(square, missing, rows);
    for (std::size_t e = 0; e < quantities(); ++e) _inputs[redundant(e)] = values[e];
  }

  [[nodiscard]] static Recorded number(const Ratio& ratio) {
    return ratio.denominator == 1 ? Recorded(ratio.numerator) : Recorded(ratio.numerator) / Recorded(ratio.denominator);
  }
  [[nodiscard]] Recorded root(std::size_t i) const { return sqrt(number(_chart.straightening->squares[i])); }
  [[nodiscard]] Recorded unit(std::size_t i, std::size_t l) const { return number(_chart.straightening->unit[i][l]); }

  /// S^-1 y.
  [[nodiscard]] Numbers in_frame(const Numbers& y) const {
    if (!_chart.straightening) return y;
    Numbers x(_n, Recorded(0.0));
    for (std::size_t i = _n; i-- > 0;) {
      x[i] = y[i] / root(i);
      for (std::size_t l = i + 1; l < _n; ++l) x[i] -= unit(i, l) * x[l];
    }
    return x;
  }

  /// S^-T g.
  [[nodiscard]] Numbers straightened_gradient(Numbers g) const {
    if (!_chart.straightening) return g;
    for (std::size_t i = 0; i < _n; ++i)
      for (std::size_t l = 0; l < i; ++l) g[i] -= unit(l, i) * g[l];
    for (std::size_t i = 0; i < _n; ++i) g[i] /= root(i);
    return g;
  }

  /// S (the rates of what is kept less those of the frame).
  template <class Entry>
  [[nodiscard]] Numbers rates(const Entry& whole) const {
    Numbers x;
    for (const std::size_t i : _chart.kept) {
      Recorded sum = whole(i);
      for (std::size_t a = 0; a < _linear.frame.size(); ++a) {
        const double factor = _linear.motions(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(a));
        if (factor != 0.0) sum -= whole(static_cast<std::size_t>(_linear.frame[a])) * factor;
      }
      x.push_back(sum);
    }
    if (!_chart.straightening) return x;
    Numbers y;
    for (std::size_t i = 0; i < _n; ++i) {
      Recorded sum = x[i];
      for (std::size_t l = i + 1; l < _n; ++l) sum += unit(i, l) * x[l];
      y.push_back(sum * root(i));
    }
    return y;
  }

  const Formulas& _plain;
  const LinearQuantities& _linear;
  const Chart& _chart;
  std::size_t _n, _d;
  model::Recording _recording;
  Numbers _parameters, _inputs;
  std::vector<Numbers> _follows;  // d redundant e / d y_c
};

}  // namespace

Formulas reduced_formulas(const System& whole, const Formulas& plain, const LinearQuantities& linear,
                          const Chart& chart) {
  return Reduction(whole, plain, linear, chart).formulas();
}

}  // namespace orbweaver::systems
