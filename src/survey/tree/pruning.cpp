#include "pruning.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

std::vector<std::string> Pruning::add_branch(const std::string& key, const Lineage& lineage,
                                             const std::vector<Meeting>& meetings,
                                             const std::vector<std::string>& passed) {
  const Number number = _graph->add_ended(key, lineage);
  for (const Meeting& meeting : meetings) _graph->add_candidate(key, meeting);
  for (const std::string& family : passed) _graph->add_passed(key, family);
  return settle({number});
}

std::vector<std::string> Pruning::add_meetings(const std::vector<std::pair<std::string, Meeting>>& meetings) {
  std::vector<Number> changed;
  for (const auto& [key, meeting] : meetings) changed.push_back(_graph->add_candidate(key, meeting));
  return settle(changed);
}

std::vector<std::string> Pruning::settle(const std::vector<Number>& changed) {
  if (_rounds.empty()) _rounds.emplace_back(*_graph, false);
  std::vector<Number> flipped;
  for (PruningRound& round : _rounds) flipped = round.update(changed, flipped);
  while (!_rounds.back().settled()) {
    std::vector<Number> dropped;
    for (Number n = 0; n < _graph->count(); ++n)
      if (_rounds.back().dropped(n)) dropped.push_back(n);
    PruningRound next(*_graph, rounds() >= free_rounds);
    next.update({}, dropped);
    _rounds.push_back(std::move(next));
    flipped.resize(static_cast<std::size_t>(_graph->count()));
    std::iota(flipped.begin(), flipped.end(), 0);
  }
  _dropped.resize(static_cast<std::size_t>(_graph->count()));
  flipped.insert(flipped.end(), changed.begin(), changed.end());
  std::vector<std::string> keys;
  for (const Number n : flipped) {
    const bool dropped = _rounds.back().dropped(n);
    if ((*_graph)[n].side == BranchGraph::none || dropped == _dropped[static_cast<std::size_t>(n)]) continue;
    _dropped[static_cast<std::size_t>(n)] = dropped;
    keys.push_back((*_graph)[n].key);
  }
  return keys;
}

BranchGraph::Number Pruning::ended(const std::string& key) const {
  const Number number = _graph->find(key);
  if (number == BranchGraph::none || (*_graph)[number].side == BranchGraph::none)
    throw core::MisuseError(fmt::format("branch \"{}\" was expected to have ended, and has not", key));
  return number;
}

bool Pruning::is_dropped(const std::string& key) const { return _rounds.back().dropped(ended(key)); }

bool Pruning::would_be_dropped(const std::string& key, const Lineage& lineage) const {
  if (_rounds.empty()) return false;
  const PruningRound& last = _rounds.back();
  for (std::string above = parent_of(key); !above.empty(); above = parent_of(above))
    if (const Number number = _graph->find(above); number != BranchGraph::none) {
      if (last.dropped(number)) return true;
      break;  // it knows of all that it lies on
    }
  const Number side = _graph->find(side_of(lineage));
  if (side == BranchGraph::none) return false;
  const auto stays_before = [&](Number other) { return !last.dropped(other) && _graph->comes_first(other, key); };
  const auto& by = last.arrivers(side);
  const auto& past = _graph->passers(side);
  return std::any_of(by.begin(), by.end(), stays_before) || std::any_of(past.begin(), past.end(), stays_before);
}

const Meeting* Pruning::arrival(const std::string& key) const {
  const BranchGraph::Candidate* found = _rounds.back().arrival(ended(key));
  return found ? &found->meeting : nullptr;
}

std::vector<std::string> Pruning::disputed() const {
  std::vector<std::string> keys;
  for (Number n = 0; n < _graph->count(); ++n)
    if ((*_graph)[n].side != BranchGraph::none && _rounds.back().disputed(n)) keys.push_back((*_graph)[n].key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace orbweaver::survey
