#include "orbweaver/report/export/auto_restart.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "export/exported_rows.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/numerics/lagrange.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/fortran.hpp"

namespace orbweaver::report {

namespace {

constexpr int points = 4;                  // NCOL, AUTO's usual number
constexpr int fewest_intervals = 20;       // NTST
constexpr int most_intervals = 2560;       // an orbit that needs more is refined by AUTO's own mesh
constexpr double mesh_tolerance = 1e-6;    // of a coordinate's range: Newton's method takes it from there
constexpr int end_point = 9;               // AUTO's type of a solution that nothing special happens at: EP
constexpr int periodic_orbits = 2;         // IPS
constexpr std::size_t numbers_a_line = 7;  // of AUTO's files
constexpr std::size_t parameters_a_line = 20;

/// The times of a mesh, in parts of the period: `points` of equal length in each interval, and the end.
std::vector<double> mesh_of(const loop::Loop& loop, int intervals) {
  const auto end_of = [&](int interval) {
    if (interval == intervals) return 1.0;
    return loop.time_map.phase(2 * std::numbers::pi * interval / intervals) / (2 * std::numbers::pi);
  };
  std::vector<double> mesh;
  for (int i = 0; i < intervals; ++i)
    for (int j = 0; j < points; ++j) mesh.push_back(end_of(i) + (end_of(i + 1) - end_of(i)) * j / points);
  mesh.push_back(1.0);
  return mesh;
}

std::vector<double> states_at(const loop::Loop& loop, const std::vector<double>& fractions) {
  std::vector<double> states;
  for (const double fraction : fractions) {
    const std::vector<double> state = loop::state_at(loop, fraction * loop.period);
    states.insert(states.end(), state.begin(), state.end());
  }
  return states;
}

/// The largest deviation of AUTO's piecewise polynomials between their nodes, in parts of each coordinate's range.
double mesh_error(const loop::Loop& loop, const std::vector<double>& mesh) {
  const auto dimension = static_cast<std::size_t>(loop.dimension);
  const std::vector<double> states = states_at(loop, mesh);
  std::vector<double> ranges(dimension, 0.0);
  for (std::size_t i = 0; i < dimension; ++i) {
    double low = states[i];
    double high = states[i];
    for (std::size_t n = i; n < states.size(); n += dimension) {
      low = std::min(low, states[n]);
      high = std::max(high, states[n]);
    }
    ranges[i] = high - low;
  }
  const double widest = std::max(*std::max_element(ranges.begin(), ranges.end()), 1e-300);
  double error = 0.0;
  for (std::size_t first = 0; first + points < mesh.size(); first += points) {
    const std::span<const double> nodes(mesh.data() + first, points + 1);
    for (const std::size_t place : {std::size_t{0}, std::size_t{2}}) {
      const double between = 0.5 * (nodes[place] + nodes[place + 1]);
      const std::vector<double> weights = numerics::lagrange_weights(nodes, between).value;
      const std::vector<double> state = loop::state_at(loop, between * loop.period);
      for (std::size_t i = 0; i < dimension; ++i) {
        double sum = -state[i];
        for (std::size_t n = 0; n < weights.size(); ++n) sum += weights[n] * states[(first + n) * dimension + i];
        error = std::max(error, std::abs(sum) / std::max(ranges[i], 1e-4 * widest));
      }
    }
  }
  return error;
}

std::vector<double> fitting_mesh(const loop::Loop& loop) {
  std::vector<double> mesh;
  for (int intervals = fewest_intervals; intervals <= most_intervals; intervals *= 2) {
    mesh = mesh_of(loop, intervals);
    if (mesh_error(loop, mesh) < mesh_tolerance) break;
  }
  return mesh;
}

/// How an orbit changes along its family: states at the mesh's times, period and the parameter that moves.
struct Direction {
  std::vector<double> states;
  double period = 0.0;
  double parameter = 0.0;
};

/// What is read of a family: its loops in units, each started as its neighbours.
class FamilyLoops {
 public:
  explicit FamilyLoops(const archive::Archive& atlas) : _atlas(atlas), _system(survey::scaled_system_of(atlas)) {}

  [[nodiscard]] loop::Loop loop(std::size_t orbit) const {
    return loop::in_units(survey::stored_loop(_atlas, orbit, *_system), _system->scales());
  }

  [[nodiscard]] Direction direction(std::size_t orbit, const std::vector<double>& mesh) const {
    const std::vector<std::int64_t>& families = _atlas.orbits().integers("family");
    const std::vector<double>& arclengths = _atlas.orbits().reals("arclength");
    std::vector<std::size_t> beside;
    if (orbit > 0 && families[orbit - 1] == families[orbit]) beside.push_back(orbit - 1);
    beside.push_back(orbit);
    if (orbit + 1 < families.size() && families[orbit + 1] == families[orbit]) beside.push_back(orbit + 1);
    const loop::Loop here = survey::stored_loop(_atlas, orbit, *_system);
    Direction direction{std::vector<double>(mesh.size() * static_cast<std::size_t>(here.dimension), 0.0), 0.0, 0.0};
    if (beside.size() == 1) {
      direction.period = 1.0;
      return direction;
    }
    std::vector<double> nodes;
    for (const std::size_t n : beside) nodes.push_back(arclengths[n]);
    const std::vector<double> slopes = numerics::lagrange_weights(nodes, arclengths[orbit]).slope;
    for (std::size_t n = 0; n < beside.size(); ++n) {
      const loop::Loop stored = survey::stored_loop(_atlas, beside[n], *_system);
      const loop::Loop near = beside[n] == orbit ? stored : survey::started_as(_system->structure(), stored, here);
      const loop::Loop in_units = loop::in_units(near, _system->scales());
      const std::vector<double> states = states_at(in_units, mesh);
      for (std::size_t i = 0; i < states.size(); ++i) direction.states[i] += slopes[n] * states[i];
      direction.period += slopes[n] * in_units.period;
      if (!in_units.parameters.empty()) direction.parameter += slopes[n] * in_units.parameters.front();
    }
    return normalized(direction, mesh);
  }

 private:
  /// Of length 1 in AUTO's measure: the mean over time of the states' squares, and the squares of the scalars.
  static Direction normalized(Direction direction, const std::vector<double>& mesh) {
    const std::size_t dimension = direction.states.size() / mesh.size();
    double square = direction.period * direction.period + direction.parameter * direction.parameter;
    for (std::size_t n = 0; n + 1 < mesh.size(); ++n)
      for (std::size_t i = 0; i < dimension; ++i) {
        const double x = direction.states[n * dimension + i];
        square += (mesh[n + 1] - mesh[n]) * x * x;
      }
    const double length = std::sqrt(square);
    for (double& x : direction.states) x /= length;
    direction.period /= length;
    direction.parameter /= length;
    return direction;
  }

  const archive::Archive& _atlas;
  std::shared_ptr<const systems::System> _system;
};

std::string lines_of(const std::vector<double>& numbers) {
  std::string text;
  for (std::size_t n = 0; n < numbers.size(); ++n)
    text += fmt::format("{}{:24.16E}{}", n % numbers_a_line == 0 ? "    " : "", numbers[n],
                        n + 1 == numbers.size() || (n + 1) % numbers_a_line == 0 ? "\n" : "");
  return text;
}

std::size_t count_of_lines(std::size_t numbers, std::size_t a_line = numbers_a_line) {
  return (numbers + a_line - 1) / a_line;
}

int parameter_number(const archive::Archive& atlas, const std::string& name) {
  const std::vector<std::string>& names = atlas.header().parameter_names;
  return auto_parameter(static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin()));
}

int energy_number(const archive::Archive& atlas) {
  return std::max(auto_period + 1, auto_parameter(static_cast<int>(atlas.header().parameter_names.size())));
}

/// PAR(1) to PAR(energy_number).
std::vector<double> par_of(const archive::Archive& atlas, std::size_t orbit) {
  std::vector<double> par(static_cast<std::size_t>(energy_number(atlas)), 0.0);
  const auto at = [&](int number) -> double& { return par[static_cast<std::size_t>(number - 1)]; };
  const std::vector<double> values = parameters_at(atlas, orbit);
  for (std::size_t i = 0; i < values.size(); ++i) at(auto_parameter(static_cast<int>(i))) = values[i];
  at(auto_period) = atlas.orbits().reals("period")[orbit];
  const double energy = atlas.orbits().reals("energy")[orbit];
  at(energy_number(atlas)) = std::isnan(energy) ? 0.0 : energy;
  return par;
}

std::string solution_text(const archive::Archive& atlas, const FamilyLoops& loops, std::size_t orbit, int label) {
  const loop::Loop loop = loops.loop(orbit);
  const std::vector<double> mesh = fitting_mesh(loop);
  const std::vector<double> states = states_at(loop, mesh);
  const Direction direction = loops.direction(orbit, mesh);
  const std::vector<double> par = par_of(atlas, orbit);
  const auto dimension = static_cast<std::size_t>(loop.dimension);
  const std::string moving = atlas.moving_parameter();
  const std::vector<int> free{moving.empty() ? auto_unfolding : parameter_number(atlas, moving), auto_period};
  const std::size_t lines = mesh.size() * (count_of_lines(dimension + 1) + count_of_lines(dimension)) +
                            count_of_lines(free.size(), parameters_a_line) + count_of_lines(free.size()) +
                            count_of_lines(par.size());
  std::string text = fmt::format("{:6}{:6}{:6}{:6}{:6}{:6}{:8}{:6}{:8}{:5}{:5}{:5}{:5}{:5}{:5}{:5}\n", 1, label,
                                 end_point, label, free.size(), 1, mesh.size(), dimension + 1, lines,
                                 mesh.size() / points, points, par.size(), 0, dimension, periodic_orbits, 0);
  const auto rows = [&](const std::vector<double>& values, bool with_time) {
    for (std::size_t n = 0; n < mesh.size(); ++n) {
      std::vector<double> row;
      if (with_time) row.push_back(mesh[n]);
      row.insert(row.end(), values.begin() + static_cast<std::ptrdiff_t>(n * dimension),
                 values.begin() + static_cast<std::ptrdiff_t>((n + 1) * dimension));
      text += lines_of(row);
    }
  };
  rows(states, true);
  text += fmt::format("{:5}\n", fmt::join(free, ""));
  text += lines_of({direction.parameter, direction.period});
  rows(direction.states, false);
  return text + lines_of(par);
}

/// AUTO asks for U(0) = U(1), which an angle that turns over does not keep.
void require_no_turns(const archive::Archive& atlas, std::size_t orbit) {
  const std::vector<std::string>& names = atlas.header().winding_names;
  for (std::size_t n = 0; n < names.size(); ++n)
    if (const double turns = atlas.orbits().reals("winding")[orbit * names.size() + n]; turns != 0.0)
      throw core::InputError(
          fmt::format("step {} turns over ({} = {}), which AUTO's periodic orbits cannot: export it as csv or json",
                      atlas.orbits().integers("step")[orbit], names[n], turns));
}

/// A Fortran subroutine's declarations of U and PAR, and the lines of code.
std::string body_of(const systems::FortranCode& code) {
  std::string text = fmt::format("  DOUBLE PRECISION v({})\n", code.lines.size() + 1);
  for (const std::string& line : code.lines) text += "  " + line + "\n";
  return text;
}

}  // namespace

void export_auto(std::ostream& out, const archive::Archive& atlas, const ExportSelection& selection) {
  if (selection.family.empty())
    throw core::InputError("expected --family: a file of AUTO has the orbits of one family");
  const std::vector<std::size_t> rows = exported_rows(atlas, selection);
  for (const std::size_t orbit : rows) require_no_turns(atlas, orbit);
  const FamilyLoops loops(atlas);
  int label = 0;
  for (const std::size_t orbit : rows) out << solution_text(atlas, loops, orbit, ++label);
}

std::string auto_equations(const archive::Archive& atlas) {
  scene::SystemChoice choice = survey::scene_of(atlas).system;
  choice.moving = {};
  const std::shared_ptr<const systems::System> system = scene::bound_system(choice);
  const auto* with_formulas = dynamic_cast<const systems::FormulaSystem*>(system.get());
  if (with_formulas == nullptr || system->structure().conserved.size() > 1)
    throw core::InputError(
        fmt::format("{} has no equations for AUTO: it {}", system->info().title,
                    with_formulas == nullptr ? "does not give its formulas" : "conserves more than one quantity"));
  const systems::Formulas formulas = with_formulas->formulas();
  const bool conserves = system->structure().conservative();
  const auto input = [](int number) { return fmt::format("U({})", number + 1); };
  const auto parameter = [&](int number) {
    return fmt::format("PAR({})", parameter_number(atlas, formulas.parameters[static_cast<std::size_t>(number)]));
  };
  std::vector<int> outputs = formulas.field;
  if (conserves)
    outputs.insert(outputs.end(), formulas.conserved_gradients.front().begin(),
                   formulas.conserved_gradients.front().end());
  const systems::FortranCode field = systems::fortran_code(formulas.graph, outputs, input, parameter);
  std::string text = fmt::format("! {}, for AUTO-07p, by Orbweaver: restart from its s.NAME with IPS=2, JAC=0.\n",
                                 system->info().title);
  for (const std::string& name : atlas.header().parameter_names)
    text += fmt::format("! PAR({}) = {}\n", parameter_number(atlas, name), name);
  text += fmt::format("! PAR({}) = period\n", auto_period);
  if (conserves)
    text += fmt::format(
        "! PAR({}) = {}\n! PAR({}) = unfolding, 0 on every orbit: it times the gradient of the {} is added\n",
        energy_number(atlas), system->structure().conserved.front(), auto_unfolding,
        system->structure().conserved.front());
  text +=
      "SUBROUTINE FUNC(NDIM,U,ICP,PAR,IJAC,F,DFDU,DFDP)\n  IMPLICIT NONE\n"
      "  INTEGER, INTENT(IN) :: NDIM, IJAC, ICP(*)\n  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)\n"
      "  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)\n  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM,*), DFDP(NDIM,*)\n" +
      body_of(field);
  const auto dimension = static_cast<std::size_t>(formulas.dimension);
  for (std::size_t i = 0; i < dimension; ++i)
    text += conserves ? fmt::format("  F({})={}+PAR({})*{}\n", i + 1, field.results[i], auto_unfolding,
                                    field.results[dimension + i])
                      : fmt::format("  F({})={}\n", i + 1, field.results[i]);
  text +=
      "END SUBROUTINE FUNC\n\nSUBROUTINE STPNT(NDIM,U,PAR,T)\n  IMPLICIT NONE\n  INTEGER, INTENT(IN) :: NDIM\n"
      "  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)\n  DOUBLE PRECISION, INTENT(IN) :: T\n"
      "  STOP 'expected a restart, IRS > 0'\nEND SUBROUTINE STPNT\n\n"
      "SUBROUTINE PVLS(NDIM,U,PAR)\n  IMPLICIT NONE\n  INTEGER, INTENT(IN) :: NDIM\n"
      "  DOUBLE PRECISION, INTENT(IN) :: U(NDIM)\n  DOUBLE PRECISION, INTENT(INOUT) :: PAR(*)\n";
  if (conserves) {
    const systems::FortranCode energy = systems::fortran_code(formulas.graph, formulas.conserved, input, parameter);
    text += body_of(energy) + fmt::format("  PAR({})={}\n", energy_number(atlas), energy.results.front());
  }
  return text +
         "END SUBROUTINE PVLS\n\nSUBROUTINE BCND\nEND SUBROUTINE BCND\nSUBROUTINE ICND\nEND SUBROUTINE ICND\n"
         "SUBROUTINE FOPT\nEND SUBROUTINE FOPT\n";
}

}  // namespace orbweaver::report
