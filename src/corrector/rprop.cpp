// The paper's optimiser as TAO types: Rprop (Riedmiller and Braun 1993) in the variant that forgets a gradient whose
// sign has flipped, and the same with the paper's linear extrapolation (section III E).
#include "rprop.hpp"

#include <algorithm>
#include <cmath>

#include <petsc/private/taoimpl.h>

#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::corrector {

namespace {

// The paper's factors are those of Riedmiller and Braun (1993, doi:10.1109/ICNN.1993.298623).
constexpr double grow = 1.2;
constexpr double shrink = 0.5;
constexpr double first_step = 1e-3;
constexpr double largest_step = 1.0;
constexpr double smallest_step = 1e-18;  // below rounding of any mode
constexpr int epoch = 50;                // iterations between extrapolations
constexpr double first_distance = 0.25;  // of the extrapolation, in ways of the last epoch
constexpr int most_doublings = 40;       // of that distance

struct Rprop {
  bool extrapolate = false;
  Vec last_gradient = nullptr;
  Vec steps = nullptr;
  Vec epoch_start = nullptr;
  Vec direction = nullptr;
  Vec trial = nullptr;
};

PetscErrorCode setup(Tao tao) {
  auto* r = static_cast<Rprop*>(tao->data);
  if (tao->gradient == nullptr) PetscCall(VecDuplicate(tao->solution, &tao->gradient));
  for (Vec* v : {&r->last_gradient, &r->steps, &r->epoch_start, &r->direction, &r->trial})
    if (*v == nullptr) PetscCall(VecDuplicate(tao->solution, v));
  return 0;
}

PetscErrorCode destroy(Tao tao) {
  auto* r = static_cast<Rprop*>(tao->data);
  for (Vec* v : {&r->last_gradient, &r->steps, &r->epoch_start, &r->direction, &r->trial}) PetscCall(VecDestroy(v));
  delete r;
  tao->data = nullptr;
  return 0;
}

// One update of every parameter by the signs of its last two gradients.
PetscErrorCode update(Tao tao, const Rprop& r) {
  PetscInt size = 0;
  PetscScalar* x = nullptr;
  PetscScalar* g = nullptr;
  PetscScalar* last = nullptr;
  PetscScalar* step = nullptr;
  PetscCall(VecGetLocalSize(tao->solution, &size));
  PetscCall(VecGetArray(tao->solution, &x));
  PetscCall(VecGetArray(tao->gradient, &g));
  PetscCall(VecGetArray(r.last_gradient, &last));
  PetscCall(VecGetArray(r.steps, &step));
  for (PetscInt i = 0; i < size; ++i) {
    const double agreement = g[i] * last[i];
    double gradient = g[i];
    if (agreement > 0.0) step[i] = std::min(grow * step[i], largest_step);
    if (agreement < 0.0) {
      step[i] = std::max(shrink * step[i], smallest_step);
      gradient = 0.0;
    }
    if (gradient != 0.0) x[i] -= std::copysign(step[i], gradient);
    last[i] = gradient;
  }
  PetscCall(VecRestoreArray(r.steps, &step));
  PetscCall(VecRestoreArray(r.last_gradient, &last));
  PetscCall(VecRestoreArray(tao->gradient, &g));
  PetscCall(VecRestoreArray(tao->solution, &x));
  return 0;
}

// Line search along the way of the last epoch: distances are doubled while the loss falls, the best point is kept.
PetscErrorCode extrapolate(Tao tao, const Rprop& r, PetscReal* value) {
  PetscReal best = *value;
  PetscReal best_distance = 0.0;
  PetscCall(VecWAXPY(r.direction, -1.0, r.epoch_start, tao->solution));
  PetscReal distance = first_distance;
  for (int n = 0; n < most_doublings; ++n, distance *= 2.0) {
    PetscReal trial = 0.0;
    PetscCall(VecWAXPY(r.trial, distance, r.direction, tao->solution));
    PetscCall(TaoComputeObjectiveAndGradient(tao, r.trial, &trial, tao->gradient));
    if (!(trial < best)) break;
    best = trial;
    best_distance = distance;
  }
  if (best_distance > 0.0) PetscCall(VecAXPY(tao->solution, best_distance, r.direction));
  PetscCall(TaoComputeObjectiveAndGradient(tao, tao->solution, value, tao->gradient));
  PetscCall(VecCopy(tao->solution, r.epoch_start));
  return 0;
}

PetscErrorCode solve(Tao tao) {
  const Rprop& r = *static_cast<Rprop*>(tao->data);
  PetscReal value = 0.0;
  PetscReal norm = 0.0;
  PetscCall(VecSet(r.steps, first_step));
  PetscCall(VecZeroEntries(r.last_gradient));
  PetscCall(VecCopy(tao->solution, r.epoch_start));
  tao->reason = TAO_CONTINUE_ITERATING;
  for (tao->niter = 0;; ++tao->niter) {
    PetscCall(TaoComputeObjectiveAndGradient(tao, tao->solution, &value, tao->gradient));
    if (r.extrapolate && tao->niter > 0 && tao->niter % epoch == 0) PetscCall(extrapolate(tao, r, &value));
    PetscCall(VecNorm(tao->gradient, NORM_2, &norm));
    PetscCall(TaoLogConvergenceHistory(tao, value, norm, 0.0, 0));
    PetscCall(TaoMonitor(tao, tao->niter, value, norm, 0.0, 0.0));
    PetscCall((*tao->ops->convergencetest)(tao, tao->cnvP));
    if (tao->reason != TAO_CONTINUE_ITERATING) return 0;
    PetscCall(update(tao, r));
  }
}

PetscErrorCode create(Tao tao, bool with_extrapolation) {
  auto* r = new Rprop;
  r->extrapolate = with_extrapolation;
  tao->data = r;
  tao->ops->setup = setup;
  tao->ops->solve = solve;
  tao->ops->destroy = destroy;
  return 0;
}

PetscErrorCode create_plain(Tao tao) { return create(tao, false); }
PetscErrorCode create_extrapolated(Tao tao) { return create(tao, true); }

}  // namespace

void register_rprop() {
  static bool done = false;
  if (done) return;
  core::check(TaoRegister("orbweaver_rprop", create_plain), "TaoRegister");
  core::check(TaoRegister("orbweaver_rprop_extrapolated", create_extrapolated), "TaoRegister");
  done = true;
}

}  // namespace orbweaver::corrector
