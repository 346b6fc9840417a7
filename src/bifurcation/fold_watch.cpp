#include "orbweaver/bifurcation/fold_watch.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

namespace {

/// True if the quantity has turned since `turn.before`.
bool turned(const FoldWatch::Turn& turn, int direction) { return turn.direction != 0 && direction != turn.direction; }

void take(FoldWatch::Turn& turn, double position, double value, Fold::Quantity quantity, std::vector<Fold>& folds) {
  if (std::isnan(value)) return;
  turn.scale = std::max(turn.scale, std::abs(value));
  if (std::isnan(turn.position)) {
    turn.position = position;
    turn.value = value;
    return;
  }
  core::require(position > turn.position, "fold watch: positions must increase");
  const double change = value - turn.value;
  if (!(std::abs(change) > FoldWatch::visible_change * turn.scale)) return;
  const int direction = change > 0.0 ? 1 : -1;
  if (turned(turn, direction)) folds.push_back({quantity, turn.before, position});
  turn.before = turn.position;
  turn.position = position;
  turn.value = value;
  turn.direction = direction;
}

/// Between the last two orbits that differ and `position`, the last one's, the slope there being `slope`.
void take_end(const FoldWatch::Turn& turn, double position, double slope, Fold::Quantity quantity,
              std::vector<Fold>& folds) {
  if (turn.direction == 0 || !(std::abs(slope) * (position - turn.before) > FoldWatch::visible_change * turn.scale))
    return;
  if (turned(turn, slope > 0.0 ? 1 : -1)) folds.push_back({quantity, turn.before, position});
}

}  // namespace

std::vector<Fold> FoldWatch::advance(double at, double period_there, double energy_there, double parameter_there) {
  std::vector<Fold> folds;
  take(period, at, period_there, Fold::Quantity::period, folds);
  take(energy, at, energy_there, Fold::Quantity::energy, folds);
  parameter.scale = std::max(parameter.scale, 1.0);  // that of the parameter, which may rest at 0
  take(parameter, at, parameter_there, Fold::Quantity::parameter, folds);
  return folds;
}

std::vector<Fold> FoldWatch::finish(double at, const Slopes& slopes) const {
  std::vector<Fold> folds;
  take_end(period, at, slopes.period, Fold::Quantity::period, folds);
  take_end(energy, at, slopes.energy, Fold::Quantity::energy, folds);
  take_end(parameter, at, slopes.parameter, Fold::Quantity::parameter, folds);
  return folds;
}

}  // namespace orbweaver::bifurcation
