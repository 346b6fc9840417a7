#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/document/suggest.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/model/phase.hpp"
#include "orbweaver/model/scope.hpp"
#include "orbweaver/systems/text/built_model.hpp"

namespace orbweaver::systems {

namespace {

using model::Graph;
using model::Indices;
using model::PlacedFormula;
using model::Scope;

constexpr const char* phase_name = "phase";
/// Coordinates of one model: a dense matrix of as many rows and columns is made at every state.
constexpr std::size_t most_coordinates = 1000;

class Builder {
 public:
  Builder(const ModelText& text, const std::map<std::string, double>& values, const std::vector<std::string>& effects)
      : _text(text), _given(values), _scope(_built.graph) {
    _built.place = text.place;
    _terms.push_back(&text.terms);
    for (const EffectText& effect : text.effects)
      if (std::find(effects.begin(), effects.end(), effect.name) != effects.end()) {
        _terms.push_back(&effect.terms);
        _effects.push_back(&effect);
        _built.effects.push_back(effect.name);
      }
    name_sizes();
    name_coordinates();
    name_parameters();
    name_definitions();
    read_ends();
  }

  [[nodiscard]] BuiltModel built() {
    if (_text.terms.lagrangian)
      take_lagrangian();
    else if (_text.terms.hamiltonian)
      take_hamiltonian();
    else
      take_equations();
    take_quantities();
    take_time();
    take_angles();
    take_guards();
    take_images();
    describe();
    return std::move(_built);
  }

 private:
  [[nodiscard]] Graph& graph() { return _built.graph; }

  [[noreturn]] static void refuse(const std::string& place, const std::string& problem) {
    throw core::InputError(fmt::format("{}: {}", place, problem));
  }

  [[nodiscard]] double value_of(const Parameter& parameter) const {
    const auto given = _given.find(parameter.name);
    return given == _given.end() ? parameter.standard : given->second;
  }

  void name_sizes() {
    for (const TermsText* terms : _terms)
      for (const ParameterText& size : terms->parameters)
        if (size.is_whole) {
          _scope.size(size.parameter.name, std::lround(value_of(size.parameter)), _text.place);
          _built.sizes[size.parameter.name] = value_of(size.parameter);
        }
  }

  /// What a line says for each of its indices.
  void each(const IndexedLine& line, const std::function<void(const Indices&)>& body) {
    std::function<void(std::size_t, Indices&)> within = [&](std::size_t level, Indices& indices) {
      if (level == line.loops.size()) return body(indices);
      const IndexLoop& loop = line.loops[level];
      const long first = _scope.whole(loop.first, loop.first.formula, indices);
      const long last = _scope.whole(loop.last, loop.last.formula, indices);
      if (last - first >= static_cast<long>(most_coordinates) * 10) loop.last.fail(1, "expected fewer indices");
      for (long at = first; at <= last; ++at) {
        indices[loop.index] = at;
        within(level + 1, indices);
      }
      indices.erase(loop.index);
    };
    Indices indices;
    within(0, indices);
  }

  [[nodiscard]] std::string name_of(const IndexedLine& line, const Indices& indices) const {
    return _scope.flat(line.name, line.index, line.formula, indices);
  }

  [[nodiscard]] std::vector<std::string> expanded(const std::vector<NameRange>& ranges) const {
    std::vector<std::string> names;
    for (const NameRange& range : ranges) {
      if (!range.range) {
        names.push_back(range.name);
        continue;
      }
      const long first = _scope.whole(range.range->first, range.range->first.formula, {});
      const long last = _scope.whole(range.range->last, range.range->last.formula, {});
      if (last - first >= static_cast<long>(most_coordinates))
        refuse(range.place, fmt::format("expected at most {} coordinates, got more", most_coordinates));
      for (long at = first; at <= last; ++at) names.push_back(fmt::format("{}{}", range.name, at));
    }
    return names;
  }

  /// Orders of derivatives by coordinates, in the order of the equations.
  void find_orders() {
    for (const TermsText* terms : _terms)
      for (const IndexedLine& line : terms->equations)
        each(line, [&](const Indices& indices) {
          const std::string name = name_of(line, indices);
          const auto [known, is_new] = _orders.emplace(name, line.order);
          if (is_new) _in_order.push_back(name);
          if (!is_new && known->second != line.order)
            refuse(line.formula.place, fmt::format("expected one order of the derivative of {}, got {} and {}", name,
                                                   known->second, line.order));
        });
  }

  void name_coordinates() {
    find_orders();
    _coordinates = expanded(_text.coordinates);
    if (_coordinates.empty()) _coordinates = _in_order;
    if (_coordinates.empty()) refuse(_text.place, "expected `coordinates`, got none; name them, [x, y]");
    if (_text.terms.equations.empty()) {
      for (const std::string& name : _coordinates) _orders[name] = _text.terms.lagrangian ? 2 : 1;
    } else {
      for (const std::string& name : _coordinates)
        if (!_orders.contains(name))
          refuse(_text.place,
                 fmt::format("expected an equation for the coordinate {0}, got none; add {0}' = ...", name));
      for (const std::string& name : _in_order)
        if (std::find(_coordinates.begin(), _coordinates.end(), name) == _coordinates.end())
          refuse(_text.place, fmt::format("the equation of `{}` has no coordinate; add it to `coordinates`", name));
    }
    _states = _coordinates;
    std::vector<std::string> second;
    for (const std::string& name : _coordinates)
      if (_orders.at(name) == 2) second.push_back(name);
    std::vector<std::string> rates = expanded(_text.velocities);
    if (_text.terms.hamiltonian) {
      rates = expanded(_text.momenta);
      if (rates.size() != _coordinates.size())
        refuse(_text.place,
               fmt::format("expected as many `momenta` as coordinates, {}, got {}", _coordinates.size(), rates.size()));
      second.clear();
    } else if (rates.empty()) {
      for (const std::string& name : second) rates.push_back(name + "_t");
    } else if (rates.size() != second.size()) {
      refuse(_text.place,
             fmt::format("expected as many `velocities` as coordinates with a second derivative, {}, got {}",
                         second.size(), rates.size()));
    }
    _states.insert(_states.end(), rates.begin(), rates.end());
    if (_states.size() > most_coordinates)
      refuse(_text.place,
             fmt::format("expected at most {} coordinates of the state, got {}", most_coordinates, _states.size()));
    for (std::size_t i = 0; i < _states.size(); ++i)
      _scope.name(_states[i], graph().input(static_cast<int>(i)), _text.place);
    for (std::size_t i = 0; i < second.size(); ++i)
      _scope.name(second[i] + "'", graph().input(static_cast<int>(_coordinates.size() + i)), _text.place);
    _phase = static_cast<int>(_states.size());
    _scope.name("t", graph().input(_phase + 1), _text.place);
    const bool has_phase =
        std::any_of(_terms.begin(), _terms.end(), [](const TermsText* terms) { return terms->frequency.has_value(); });
    if (has_phase) _scope.name(phase_name, graph().input(_phase), _text.place);
  }

  void name_parameters() {
    for (const TermsText* terms : _terms)
      for (const ParameterText& text : terms->parameters) {
        if (text.is_whole) continue;
        const std::string& name = text.parameter.name;
        if (std::find(_built.parameters.begin(), _built.parameters.end(), name) != _built.parameters.end()) continue;
        _scope.name(name, graph().parameter(static_cast<int>(_built.parameters.size())), _text.place);
        _built.parameters.push_back(name);
        _values.push_back(value_of(text.parameter));
      }
  }

  void name_definitions() {
    for (const TermsText* terms : _terms)
      for (const IndexedLine& line : terms->definitions) define(line, false);
    for (const TermsText* terms : _terms)
      for (const IndexedLine& line : terms->added) define(line, true);
  }

  void define(const IndexedLine& line, bool adds) {
    each(line, [&](const Indices& indices) {
      _scope.define(name_of(line, indices), line.arguments, line.formula, indices, adds);
    });
  }

  void read_ends() {
    for (const ModelText::EndsText& ends : _text.ends) {
      const auto range = std::find_if(_text.coordinates.begin(), _text.coordinates.end(), [&](const NameRange& one) {
        return one.name == ends.name && one.range.has_value();
      });
      if (range == _text.coordinates.end())
        refuse(_text.place, fmt::format("`ends` names {0}, which is no coordinate {0}[1..n]", ends.name));
      Scope::Ends own;
      own.first = _scope.whole(range->range->first, range->range->first.formula, {});
      own.last = _scope.whole(range->range->last, range->range->last.formula, {});
      own.cyclic = ends.cyclic;
      for (const auto& [index, value] : ends.beyond) own.beyond.emplace(_scope.whole(index, index.formula, {}), value);
      _scope.ends(ends.name, std::move(own));
    }
  }

  /// The sum of one formula of the model and of its effects.
  int total(std::optional<PlacedFormula> TermsText::*formula) {
    int sum = graph().constant(0.0);
    for (const TermsText* terms : _terms)
      if (terms->*formula) sum = graph().add(sum, _scope.evaluate(*(terms->*formula)));
    return sum;
  }

  [[nodiscard]] std::vector<int> inputs(std::size_t from, std::size_t to) const {
    std::vector<int> numbers;
    for (std::size_t i = from; i < to; ++i) numbers.push_back(static_cast<int>(i));
    return numbers;
  }

  [[nodiscard]] int or_zero(int node) { return node < 0 ? graph().constant(0.0) : node; }

  /// By coordinates.
  std::vector<int> forces() {
    std::vector<int> acting(_coordinates.size(), graph().constant(0.0));
    for (const TermsText* terms : _terms)
      for (const IndexedLine& line : terms->forces)
        each(line, [&](const Indices& indices) {
          const std::string name = name_of(line, indices);
          const auto at = std::find(_coordinates.begin(), _coordinates.end(), name);
          if (at == _coordinates.end())
            refuse(line.formula.place, fmt::format("expected a force on a coordinate, got `{}`", name));
          int& force = acting[static_cast<std::size_t>(at - _coordinates.begin())];
          force = graph().add(force, _scope.evaluate(line.formula, indices));
          _has_forces = true;
        });
    return acting;
  }

  void take_hamiltonian() {
    const std::size_t n = _coordinates.size();
    const int energy = total(&TermsText::hamiltonian);
    const std::vector<int> slopes = model::gradient(graph(), energy, inputs(0, 2 * n));
    const std::vector<int> acting = forces();
    for (std::size_t i = 0; i < n; ++i) _built.field.push_back(or_zero(slopes[n + i]));
    for (std::size_t i = 0; i < n; ++i) _built.field.push_back(graph().subtract(acting[i], or_zero(slopes[i])));
    int action = graph().constant(0.0);
    for (std::size_t i = 0; i < n; ++i)
      action = graph().add(action, graph().multiply(graph().input(static_cast<int>(n + i)), _built.field[i]));
    if (_has_forces) _pushed = acting;
    _first_pushed = n;
    finish(energy, action, acting);
  }

  /// The sum of the derivatives of nodes by the inputs from `first` on.
  int divergence(const std::vector<int>& nodes, std::size_t first) {
    int sum = graph().constant(0.0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const int slope = model::gradient(graph(), nodes[i], std::vector<int>{static_cast<int>(first + i)}).front();
      sum = graph().add(sum, or_zero(slope));
    }
    return sum;
  }

  void take_lagrangian() {
    const std::size_t n = _coordinates.size();
    const int lagrangian = total(&TermsText::lagrangian);
    const std::vector<int> slopes = model::gradient(graph(), lagrangian, inputs(0, 2 * n));
    const std::vector<int> acting = forces();
    std::vector<int> momenta;
    for (std::size_t i = 0; i < n; ++i) momenta.push_back(or_zero(slopes[n + i]));
    // d/dt (dL/dv) = M a + (its change as q moves with v, and t) = dL/dq + Q
    const std::size_t width = 2 * n;
    const std::vector<int> second = model::jacobian(graph(), momenta, static_cast<int>(width));
    model::Direction moving;
    moving.inputs.assign(width + 2, -1);
    for (std::size_t i = 0; i < n; ++i) moving.inputs[i] = graph().input(static_cast<int>(n + i));
    for (const TermsText* terms : _terms)
      if (terms->frequency) moving.inputs[width] = frequency();
    moving.inputs[width + 1] = graph().constant(1.0);
    const std::vector<int> change = model::derivatives_along(graph(), momenta, moving);
    std::vector<std::vector<int>> mass(n, std::vector<int>(n));
    std::vector<int> right;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) mass[i][j] = second[i * width + n + j];
      right.push_back(graph().subtract(graph().add(or_zero(slopes[i]), acting[i]), or_zero(change[i])));
    }
    const std::vector<int> rates = solved(mass, right);
    if (_has_forces) _pushed = solved(mass, acting);
    _first_pushed = n;
    int energy = graph().negate(lagrangian);
    int action = graph().constant(0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const int velocity = graph().input(static_cast<int>(n + i));
      _built.field.push_back(velocity);
      action = graph().add(action, graph().multiply(momenta[i], velocity));
    }
    energy = graph().add(action, energy);
    _built.field.insert(_built.field.end(), rates.begin(), rates.end());
    finish(energy, action, acting);
  }

  /// Elimination without pivots in the graph, of a mass matrix, which is positive.
  std::vector<int> solved(std::vector<std::vector<int>> mass, std::vector<int> right) {
    const std::size_t n = right.size();
    for (std::size_t a = 0; a < n; ++a) {
      if (graph().is_constant(mass[a][a], 0.0))
        refuse(_text.place, fmt::format("expected a kinetic energy in the rate of {}, got a Lagrangian without it",
                                        _coordinates[a]));
      for (std::size_t b = a + 1; b < n; ++b) {
        if (graph().is_constant(mass[b][a], 0.0)) continue;
        const int factor = graph().divide(mass[b][a], mass[a][a]);
        for (std::size_t c = a + 1; c < n; ++c)
          mass[b][c] = graph().subtract(mass[b][c], graph().multiply(factor, mass[a][c]));
        right[b] = graph().subtract(right[b], graph().multiply(factor, right[a]));
      }
    }
    for (std::size_t a = n; a-- > 0;) {
      for (std::size_t c = a + 1; c < n; ++c)
        right[a] = graph().subtract(right[a], graph().multiply(mass[a][c], right[c]));
      right[a] = graph().divide(right[a], mass[a][a]);
    }
    return right;
  }

  void finish(int energy, int action, const std::vector<int>& acting) {
    _built.action = action;
    _built.is_canonical = !_has_forces;
    _built.quantities.push_back({"energy", energy, true});
    if (!_has_forces) return;
    _built.power = graph().constant(0.0);
    for (std::size_t i = 0; i < acting.size(); ++i)
      _built.power = graph().add(_built.power, graph().multiply(acting[i], _built.field[i]));
  }

  void take_equations() {
    for (const TermsText* terms : _terms)
      if (!terms->forces.empty() || (terms != &_text.terms && (terms->hamiltonian || terms->lagrangian)))
        refuse(_text.place, "expected `equations` in effects, as in the model, got forces or an energy");
    std::map<std::string, int> sides;
    for (const TermsText* terms : _terms) {
      std::set<std::string> own;
      for (const IndexedLine& line : terms->equations)
        each(line, [&](const Indices& indices) {
          const std::string name = name_of(line, indices);
          if (!own.insert(name).second)
            refuse(line.formula.place, fmt::format("expected one equation for {}, got another", name));
          const int side = _scope.evaluate(line.formula, indices);
          const auto [known, is_new] = sides.emplace(name, side);
          if (!is_new) known->second = graph().add(known->second, side);
        });
    }
    std::size_t second = _coordinates.size();
    std::vector<int> rates;
    for (const std::string& name : _coordinates) {
      const bool twice = _orders.at(name) == 2;
      _built.field.push_back(twice ? graph().input(static_cast<int>(second++)) : sides.at(name));
      if (twice) rates.push_back(sides.at(name));
    }
    _built.field.insert(_built.field.end(), rates.begin(), rates.end());
    if (_text.action) _built.action = _scope.evaluate(*_text.action);
    _pushed = _built.field;
  }

  void take_quantities() {
    for (const auto& [name, formula] : _text.conserved)
      _built.quantities.push_back({name, _scope.evaluate(formula), true});
  }

  int frequency() {
    for (const TermsText* terms : _terms)
      if (terms->frequency) return _scope.evaluate(*terms->frequency);
    refuse(_text.place, "expected a drive's frequency, got a phase without it");
  }

  void take_time() {
    std::optional<int> given;
    for (const TermsText* terms : _terms)
      if (terms->frequency && !given) given = _scope.evaluate(*terms->frequency);
    std::vector<int> outputs = _built.field;
    const std::size_t rates = outputs.size();
    const std::vector<int*> others{&_built.action, &_built.power};
    for (const int* other : others)
      if (*other >= 0) outputs.push_back(*other);
    outputs.insert(outputs.end(), _pushed.begin(), _pushed.end());
    const model::Phased phased = model::with_phase(graph(), outputs, _phase + 1, _phase, given, _values);
    if (!phased.obstacle.empty())
      refuse(
          _text.place,
          fmt::format("expected time as c*t + something within sin and cos, the numbers c rational multiples of one "
                      "another, got {}; a drive of another kind is a pair of coordinates, u' = v + u*(1 - u^2 - v^2) "
                      "and v' = -u + v*(1 - u^2 - v^2)",
                      phased.obstacle));
    std::copy_n(phased.outputs.begin(), rates, _built.field.begin());
    std::size_t next = rates;
    for (int* other : others)
      if (*other >= 0) *other = phased.outputs[next++];
    for (int& pushed : _pushed) pushed = phased.outputs[next++];
    if (!_pushed.empty()) _built.growth = divergence(_pushed, _first_pushed);
    _built.is_driven = phased.frequency >= 0;
    if (!_built.is_driven) return;
    _built.field.push_back(phased.frequency);
    _states.emplace_back(phase_name);
    if (!_scope.knows(phase_name)) _scope.name(phase_name, graph().input(_phase), _text.place);
    _built.quantities.clear();
  }

  [[nodiscard]] int number_of(const std::string& name, const std::string& place) const {
    const auto at = std::find(_states.begin(), _states.end(), name);
    if (at == _states.end()) {
      const std::string near = document::nearest(name, _states);
      refuse(place, fmt::format("expected a coordinate, got `{}`; {}", name,
                                near.empty() ? fmt::format("there are {}", fmt::join(_states, ", "))
                                             : fmt::format("did you mean `{}`?", near)));
    }
    return static_cast<int>(at - _states.begin());
  }

  void take_angles() {
    std::set<std::string> not_angles;
    for (const EffectText* effect : _effects)
      for (const std::string& name : expanded(effect->no_angles)) not_angles.insert(name);
    _windings.assign(_states.size(), "");
    for (const NameRange& range : _text.angles)
      for (const std::string& name : expanded({range})) {
        const int i = number_of(name, range.place);
        const auto known = _text.windings.find(range.name);
        std::string& winding = _windings[static_cast<std::size_t>(i)];
        winding = known == _text.windings.end() ? "n_" + name
                  : range.range                 ? known->second + name.substr(range.name.size())
                                                : known->second;
        if (!not_angles.contains(name)) _built.angles.push_back(i);
      }
    if (_built.is_driven) {
      _windings.back() = std::string("n_") + phase_name;
      _built.angles.push_back(_phase);
    }
  }

  void take_guards() {
    for (const TermsText* terms : _terms)
      for (const auto& [guard, formula] : terms->guards) {
        _built.named_guards.push_back(guard);
        _built.guards.push_back(_scope.evaluate(formula));
      }
  }

  void take_images() {
    for (const SymmetryText& symmetry : _text.symmetries) {
      BuiltModel::Image image{symmetry.name, symmetry.reverses, symmetry.if_it_holds, {}, symmetry.place};
      for (std::size_t i = 0; i < _states.size(); ++i) image.nodes.push_back(graph().input(static_cast<int>(i)));
      if (_built.is_driven && symmetry.reverses) image.nodes.back() = graph().negate(image.nodes.back());
      bool is_whole = true;
      for (const IndexedLine& line : symmetry.images)
        each(line, [&](const Indices& indices) {
          const std::string name = name_of(line, indices);
          if (name == phase_name && !_built.is_driven) {
            is_whole = false;
            return;
          }
          image.nodes[static_cast<std::size_t>(number_of(name, line.formula.place))] =
              _scope.evaluate(line.formula, indices);
        });
      if (is_whole) _built.images.push_back(std::move(image));
    }
  }

  void describe() {
    ModelInfo& info = _built.info;
    info.name = _text.name;
    info.title = _text.title;
    if (!_built.effects.empty()) info.title += fmt::format(" with {}", fmt::join(_built.effects, ", "));
    info.meaning = _text.meaning;
    info.state_names = _states;
    info.winding_names = _windings;
    for (const ParameterText& text : _text.terms.parameters) info.parameters.push_back(text.parameter);
    for (const EffectText& effect : _text.effects) {
      Effect& own = info.effects.emplace_back();
      own.name = effect.name;
      own.meaning = effect.meaning.empty() ? effect.name : effect.meaning;
      for (const ParameterText& text : effect.terms.parameters) own.parameters.push_back(text.parameter);
    }
  }

  const ModelText& _text;
  std::map<std::string, double> _given;
  BuiltModel _built;
  Scope _scope;
  std::vector<const TermsText*> _terms;  // of the model, and of the effects that are on
  std::vector<const EffectText*> _effects;
  std::vector<std::string> _coordinates;
  std::vector<std::string> _states;
  std::vector<std::string> _windings;
  std::map<std::string, int> _orders;
  std::vector<std::string> _in_order;
  std::vector<double> _values;  // of the parameters
  int _phase = 0;
  bool _has_forces = false;
  std::vector<int> _pushed;  // rates whose divergence is the growth of volumes, of the inputs from the next on
  std::size_t _first_pushed = 0;
};

}  // namespace

BuiltModel build_model(const ModelText& text, const std::map<std::string, double>& values,
                       const std::vector<std::string>& effects) {
  return Builder(text, values, effects).built();
}

ModelInfo info_of(const ModelText& text) { return build_model(text, {}, {}).info; }

}  // namespace orbweaver::systems
