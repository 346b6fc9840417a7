#include "branch_graph.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

BranchGraph::Number BranchGraph::known(const std::string& key) {
  const auto [place, is_new] = _numbers.try_emplace(key, count());
  const Number number = place->second;
  if (!is_new) return number;
  _branches.emplace_back();
  at(number).key = key;
  at(number).depth = depth_of(key);
  const std::string parent = parent_of(key);
  if (parent.empty()) return number;
  const Number above = known(parent);
  at(number).parent = above;
  at(above).children.push_back(number);
  return number;
}

BranchGraph::Number BranchGraph::known(const Side& side) {
  const auto [place, is_new] = _sides.try_emplace(side, side_count());
  if (is_new) {
    _starters.emplace_back();
    _passers.emplace_back();
  }
  return place->second;
}

BranchGraph::Number BranchGraph::add_ended(const std::string& key, const Lineage& lineage) {
  const Number number = known(key);
  Branch& branch = at(number);
  if (branch.side != none) throw core::MisuseError(fmt::format("a branch ends once; \"{}\" had ended before", key));
  branch.side = known(side_of(lineage));
  _starters[static_cast<std::size_t>(branch.side)].push_back(number);
  return number;
}

BranchGraph::Number BranchGraph::add_candidate(const std::string& key, const Meeting& meeting) {
  const Number number = find(key);
  core::require(number != none && at(number).side != none, "only a branch that has ended may have arrived somewhere");
  Candidate candidate{meeting, known(branch_of(meeting.crossing)), known(meeting.along)};
  at(candidate.on).visitors.push_back(number);
  std::vector<Candidate>& all = at(number).candidates;
  const auto place = std::upper_bound(all.begin(), all.end(), candidate, [](const Candidate& a, const Candidate& b) {
    return std::tie(a.meeting.away, a.meeting.crossing) < std::tie(b.meeting.away, b.meeting.crossing);
  });
  all.insert(place, std::move(candidate));
  return number;
}

void BranchGraph::add_passed(const std::string& key, const std::string& family) {
  const Number number = find(key);
  core::require(number != none && at(number).side != none, "only a branch that has ended has passed anything");
  for (const int side : {1, -1}) {
    const Number beginning = known(Side{family, side});
    at(number).passes.push_back(beginning);
    _passers[static_cast<std::size_t>(beginning)].push_back(number);
  }
}

BranchGraph::Number BranchGraph::find(const std::string& key) const {
  const auto found = _numbers.find(key);
  return found == _numbers.end() ? none : found->second;
}

BranchGraph::Number BranchGraph::find(const Side& side) const {
  const auto found = _sides.find(side);
  return found == _sides.end() ? none : found->second;
}

bool BranchGraph::comes_first(Number a, Number b) const {
  const Branch& left = (*this)[a];
  const Branch& right = (*this)[b];
  return std::tie(left.depth, left.key) < std::tie(right.depth, right.key);
}

bool BranchGraph::comes_first(Number a, const std::string& key) const {
  const int depth = depth_of(key);
  return std::tie((*this)[a].depth, (*this)[a].key) < std::tie(depth, key);
}

bool BranchGraph::lies_on(Number a, Number b) const {
  for (Number above = (*this)[a].parent; above != none; above = (*this)[above].parent)
    if (above == b) return true;
  return false;
}

}  // namespace orbweaver::survey
