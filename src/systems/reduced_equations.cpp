#include "reduced_equations.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/model/derivatives.hpp"
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
class Rewriting {
 public:
  Rewriting(const GraphSystem& whole, const LinearQuantities& linear, const Chart& chart)
      : _plain(whole.equations()),
        _linear(linear),
        _chart(chart),
        _n(chart.kept.size()),
        _d(static_cast<std::size_t>(chart.states.rows())) {
    for (std::size_t p = 0; p < _plain.parameters.size(); ++p)
      _parameters.push_back(_recording.parameter(static_cast<int>(p)));
    _inputs.assign(_d, Recorded(0.0));
    Numbers y;
    for (std::size_t c = 0; c < _n; ++c) y.push_back(_recording.input(static_cast<int>(c)));
    const Numbers x = in_frame(y);
    for (std::size_t c = 0; c < _n; ++c) _inputs[chart.kept[c]] = x[c];
    solve_for_redundant(whole.structure().conserved);
  }

  [[nodiscard]] Equations equations() {
    Equations out{{}, _plain.parameters, {}, {}, {}, -1};
    for (const Recorded& rate : rates(nodes_of(_plain.field))) out.field.push_back(rate.node());
    for (const int other : _chart.others)
      out.conserved.push_back(nodes_of({_plain.conserved[static_cast<std::size_t>(other)]}).front().node());
    for (const Recorded& guard : nodes_of(_plain.guards)) out.guards.push_back(guard.node());
    if (_plain.action >= 0) out.action = nodes_of({_plain.action}).front().node();
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
  void solve_for_redundant(const std::vector<std::string>& names) {
    std::vector<Numbers> square;
    Numbers missing;
    for (const int quantity : _linear.quantities) {
      const auto q = static_cast<std::size_t>(quantity);
      std::vector<int> slopes = model::gradient(_plain.graph, _plain.conserved[q], _linear.redundant);
      for (int& slope : slopes)
        if (slope < 0) slope = _plain.graph.constant(0.0);
      square.push_back(nodes_of(slopes));
      const auto held = std::find(_plain.parameters.begin(), _plain.parameters.end(), names[q]);
      const Recorded value = held == _plain.parameters.end()
                                 ? Recorded(0.0)
                                 : _parameters[static_cast<std::size_t>(held - _plain.parameters.begin())];
      missing.push_back(value - nodes_of({_plain.conserved[q]}).front());
    }
    const Numbers values =
        solved(square, missing, pivot_rows(rows_of(_chart.gradients, _linear.redundant).transpose()));
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

  /// S (the rates of what is kept less those of the frame).
  [[nodiscard]] Numbers rates(const Numbers& whole) const {
    Numbers x;
    for (const std::size_t i : _chart.kept) {
      Recorded sum = whole[i];
      for (std::size_t a = 0; a < _linear.frame.size(); ++a) {
        const double factor = _linear.motions(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(a));
        if (factor != 0.0) sum -= whole[static_cast<std::size_t>(_linear.frame[a])] * factor;
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

  Equations _plain;
  const LinearQuantities& _linear;
  const Chart& _chart;
  std::size_t _n, _d;
  model::Recording _recording;
  Numbers _parameters, _inputs;
};

}  // namespace

Equations reduced_equations(const GraphSystem& whole, const LinearQuantities& linear, const Chart& chart) {
  return Rewriting(whole, linear, chart).equations();
}

}  // namespace orbweaver::systems
