#include "orbweaver/model/phase.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "orbweaver/model/evaluate.hpp"

namespace orbweaver::model {

namespace {

/// A rational number.
struct Ratio {
  long over = 0;
  long under = 1;
};

/// The ratio with the least denominator that a number is to rounding, by its continued fraction.
std::optional<Ratio> ratio_of(double x) {
  constexpr long most = 1000;
  constexpr double rounding = 1e-11;
  for (long under = 1; under <= most; ++under) {
    const double over = std::round(x * static_cast<double>(under));
    if (over != 0.0 && std::abs(x * static_cast<double>(under) - over) < rounding * std::abs(over))
      return Ratio{static_cast<long>(over), under};
  }
  return std::nullopt;
}

class Conversion {
 public:
  Conversion(Graph& graph, std::span<const int> outputs, int time)
      : _graph(graph), _outputs(outputs), _time(time), _needed(needed_for(graph, outputs)) {
    find_rates();
  }

  [[nodiscard]] const std::string& obstacle() const { return _obstacle; }
  /// The numbers c, by their nodes.
  [[nodiscard]] std::vector<int> rates() const {
    std::vector<int> all;
    for (const auto& [wave, rate] : _waves)
      if (std::find(all.begin(), all.end(), rate) == all.end()) all.push_back(rate);
    return all;
  }

  /// The outputs, `turns` being the multiple of the phase that stands for each c t.
  [[nodiscard]] std::vector<int> rewritten(const std::map<int, long>& turns, int phase) {
    std::vector<int> place(_needed.size(), -1);
    const auto at = [&](int n) { return place[static_cast<std::size_t>(n)]; };
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n]) continue;
      const Node node = _graph.nodes()[n];
      const auto own = static_cast<int>(n);
      if (node.operation == Operation::input && node.first == _time) {
        place[n] = _graph.constant(0.0);
      } else if (is_leaf(node.operation)) {
        place[n] = own;
      } else {
        int operand = at(node.first);
        if (const auto wave = _waves.find(own); wave != _waves.end()) {
          const int turned =
              _graph.multiply(_graph.constant(static_cast<double>(turns.at(wave->second))), _graph.input(phase));
          operand = _graph.add(turned, operand);
        }
        place[n] = _graph.again(node, operand, node.operation <= Operation::divide ? at(node.second) : -1);
      }
    }
    std::vector<int> results;
    for (const int output : _outputs) results.push_back(at(output));
    return results;
  }

 private:
  /// The derivative by time of what is c t + (something without t); sines and cosines end it.
  void find_rates() {
    std::vector<int> rate(_needed.size(), -1);
    const auto of = [&](int n) { return rate[static_cast<std::size_t>(n)]; };
    for (std::size_t n = 0; n < _needed.size() && _obstacle.empty(); ++n) {
      if (!_needed[n]) continue;
      const Node node = _graph.nodes()[n];
      if (node.operation == Operation::input && node.first == _time) rate[n] = _graph.constant(1.0);
      if (is_leaf(node.operation)) continue;
      const bool two = node.operation <= Operation::divide;
      const int a = of(node.first);
      const int b = two ? of(node.second) : -1;
      if (a < 0 && b < 0) continue;
      switch (node.operation) {
        case Operation::add: rate[n] = a < 0 ? b : b < 0 ? a : _graph.add(a, b); break;
        case Operation::subtract: rate[n] = a < 0 ? _graph.negate(b) : b < 0 ? a : _graph.subtract(a, b); break;
        case Operation::multiply:
          if (a >= 0 && b >= 0) refuse("a product of time with itself");
          rate[n] = a < 0 ? _graph.multiply(b, node.first) : _graph.multiply(a, node.second);
          break;
        case Operation::divide:
          if (b >= 0) refuse("a quotient by time");
          rate[n] = a < 0 ? -1 : _graph.divide(a, node.second);
          break;
        case Operation::negate: rate[n] = _graph.negate(a); break;
        case Operation::sine:
        case Operation::cosine: _waves[static_cast<int>(n)] = a; break;
        default: refuse("time within a function that is no sine and no cosine");
      }
    }
    for (const int output : _outputs)
      if (of(output) >= 0) refuse("time outside of sines and cosines");
    for (const auto& [wave, factor] : _waves) {
      const std::vector<int> one{factor};
      const std::vector<bool> within = needed_for(_graph, one);
      for (std::size_t n = 0; n < within.size(); ++n)
        if (within[n] && _graph.nodes()[n].operation == Operation::input)
          refuse("time multiplied by something that moves");
    }
  }

  void refuse(const std::string& what) {
    if (_obstacle.empty()) _obstacle = what;
  }

  Graph& _graph;
  std::span<const int> _outputs;
  int _time;
  std::vector<bool> _needed;
  std::map<int, int> _waves;  // rates by their sines and cosines
  std::string _obstacle;
};

/// Values of nodes for the parameters given, and for two other choices of them.
std::vector<std::vector<double>> tried(const Graph& graph, const std::vector<int>& nodes,
                                       std::span<const double> values) {
  std::vector<std::vector<double>> all;
  for (const double change : {0.0, 0.37, 0.83}) {
    std::vector<double> moved(values.begin(), values.end());
    for (std::size_t n = 0; n < moved.size(); ++n)
      moved[n] += change * (1.0 + std::abs(moved[n])) / (1.0 + 0.1 * static_cast<double>(n));
    all.push_back(evaluate<double>(graph, nodes, std::span<const double>(), std::span<const double>(moved)));
  }
  return all;
}

}  // namespace

Phased with_phase(Graph& graph, std::span<const int> outputs, int time, int phase, std::optional<int> frequency,
                  std::span<const double> values) {
  Phased result;
  result.outputs.assign(outputs.begin(), outputs.end());
  Conversion conversion(graph, outputs, time);
  result.obstacle = conversion.obstacle();
  if (!result.obstacle.empty()) return result;
  const std::vector<int> rates = conversion.rates();
  if (rates.empty()) {
    if (frequency) result.frequency = *frequency;
    return result;
  }
  std::vector<int> compared = rates;
  compared.push_back(frequency ? *frequency : rates.front());
  auto trials = tried(graph, compared, values);
  if (!frequency && trials[0].back() < 0.0) {
    compared.back() = graph.negate(rates.front());
    trials = tried(graph, compared, values);
  }
  const int base = compared.back();
  std::vector<Ratio> ratios;
  for (std::size_t n = 0; n < rates.size(); ++n) {
    const auto ratio = ratio_of(trials[0][n] / trials[0].back());
    for (const std::vector<double>& trial : trials) {
      const double moved = trial[n] / trial.back();
      const bool is_same =
          ratio && std::abs(moved * static_cast<double>(ratio->under) - static_cast<double>(ratio->over)) <
                       1e-9 * std::abs(static_cast<double>(ratio->over));
      if (!is_same) result.obstacle = "frequencies that are no rational multiples of one another";
    }
    if (!result.obstacle.empty()) return result;
    ratios.push_back(*ratio);
  }
  long under = 1;
  for (const Ratio& ratio : ratios) under = std::lcm(under, ratio.under);
  long over = 0;
  for (const Ratio& ratio : ratios) over = std::gcd(over, ratio.over * (under / ratio.under));
  if (frequency) {
    if (under != 1) {
      result.obstacle = "frequencies that are no whole multiples of the drive's";
      return result;
    }
    over = 1;
  }
  std::map<int, long> turns;
  for (std::size_t n = 0; n < rates.size(); ++n) turns[rates[n]] = ratios[n].over * (under / ratios[n].under) / over;
  result.frequency = graph.divide(graph.multiply(base, graph.constant(static_cast<double>(over))),
                                  graph.constant(static_cast<double>(under)));
  result.outputs = conversion.rewritten(turns, phase);
  return result;
}

}  // namespace orbweaver::model
