#include "pruning_round.hpp"

#include <algorithm>

namespace orbweaver::survey {

const BranchGraph::Candidate* PruningRound::arrival(Number n) const {
  const int candidate = state(n).candidate;
  return candidate < 0 ? nullptr : &(*_graph)[n].candidates[static_cast<std::size_t>(candidate)];
}

void PruningRound::look(Number n, Pending& first, Pending& second) {
  const auto concern = [&](Number side) {
    if (side == BranchGraph::none) return;
    for (const Number starter : _graph->starters(side)) {
      first.insert(starter);
      second.insert(starter);
    }
  };
  // The number of a candidate may stand for another one than it did: forget it, and enter it again.
  concern(state(n).side);
  if (state(n).side != BranchGraph::none) std::erase(_arrivers[static_cast<std::size_t>(state(n).side)], n);
  const auto& candidates = (*_graph)[n].candidates;
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [this](const BranchGraph::Candidate& c) { return !state(c.on).before; });
  const bool arrives = found != candidates.end();
  state(n).candidate = arrives ? static_cast<int>(found - candidates.begin()) : -1;
  state(n).side = arrives ? found->side : BranchGraph::none;
  concern(state(n).side);
  if (state(n).side != BranchGraph::none) _arrivers[static_cast<std::size_t>(state(n).side)].push_back(n);
  for (const Number side : (*_graph)[n].passes) concern(side);
  second.insert(n);
}

bool PruningRound::is_by_earlier(Number n) const {
  const BranchGraph::Branch& branch = (*_graph)[n];
  if (branch.parent != BranchGraph::none && state(branch.parent).by_earlier) return true;
  if (branch.side == BranchGraph::none) return false;
  const auto stays_before = [&](Number other) { return !state(other).by_earlier && _graph->comes_first(other, n); };
  const auto& by = arrivers(branch.side);
  const auto& past = _graph->passers(branch.side);
  return std::any_of(by.begin(), by.end(), stays_before) || std::any_of(past.begin(), past.end(), stays_before);
}

bool PruningRound::is_by_rule(Number n) const {
  const BranchGraph::Branch& branch = (*_graph)[n];
  if (state(n).by_earlier || (branch.parent != BranchGraph::none && state(branch.parent).by_rule)) return true;
  if (branch.side == BranchGraph::none) return false;
  const auto& by = arrivers(branch.side);
  return std::any_of(by.begin(), by.end(), [&](Number other) {
    return !state(other).by_earlier && _graph->comes_first(n, other) && !_graph->lies_on(other, n) &&
           state(n).side != (*_graph)[other].side;
  });
}

std::vector<BranchGraph::Number> PruningRound::update(const std::vector<Number>& changed,
                                                      const std::vector<Number>& flipped) {
  Pending first(Earlier{_graph});
  Pending second(Earlier{_graph});
  std::set<Number> looking(changed.begin(), changed.end());
  for (auto n = static_cast<Number>(_states.size()); n < _graph->count(); ++n) looking.insert(n);
  _states.resize(static_cast<std::size_t>(_graph->count()));
  _arrivers.resize(static_cast<std::size_t>(_graph->side_count()));
  first.insert(looking.begin(), looking.end());
  for (const Number n : flipped) {
    state(n).before = !state(n).before;
    _differing += state(n).before != state(n).dropped ? 1 : -1;
    looking.insert((*_graph)[n].visitors.begin(), (*_graph)[n].visitors.end());
    if (_only_fewer) second.insert(n);
  }
  for (const Number n : looking) look(n, first, second);

  // Only later ones are added while the earliest is taken out, so each is judged once.
  while (!first.empty()) {
    const Number n = first.extract(first.begin()).value();
    if (is_by_earlier(n) == state(n).by_earlier) continue;
    state(n).by_earlier = !state(n).by_earlier;
    second.insert(n);
    const auto& children = (*_graph)[n].children;
    first.insert(children.begin(), children.end());
    std::vector<Number> sides = (*_graph)[n].passes;
    if (state(n).side != BranchGraph::none) sides.push_back(state(n).side);
    for (const Number side : sides)
      for (const Number starter : _graph->starters(side)) {
        second.insert(starter);
        if (_graph->comes_first(n, starter)) first.insert(starter);
      }
  }
  std::vector<Number> flips;
  while (!second.empty()) {
    const Number n = second.extract(second.begin()).value();
    const bool by_rule = is_by_rule(n);
    if (by_rule != state(n).by_rule) {
      state(n).by_rule = by_rule;
      const auto& children = (*_graph)[n].children;
      second.insert(children.begin(), children.end());
    }
    const bool dropped = by_rule && (!_only_fewer || state(n).before);
    if (dropped == state(n).dropped) continue;
    state(n).dropped = dropped;
    _differing += state(n).before != dropped ? 1 : -1;
    flips.push_back(n);
  }
  return flips;
}

}  // namespace orbweaver::survey
