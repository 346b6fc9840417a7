#include "family_limit.hpp"

namespace orbweaver::survey {

void FamilyLimit::count(const Place& place, const std::string& family, bool counts) {
  std::set<Place>& branches = _branches[family];
  if (counts == branches.contains(place)) return;
  if (!branches.empty()) erase(*branches.begin());
  if (counts)
    branches.insert(place);
  else
    branches.erase(place);
  if (!branches.empty()) insert(*branches.begin());
}

bool FamilyLimit::has_room(const Place& place, const std::string& family) const {
  const auto branches = _branches.find(family);
  if (branches != _branches.end() && !branches->second.empty() && *branches->second.begin() < place) return true;
  return _within.size() < _most || (!_within.empty() && !(*_within.rbegin() < place));
}

void FamilyLimit::insert(const Place& first) {
  _within.insert(first);
  if (_within.size() > _most) _beyond.insert(_within.extract(std::prev(_within.end())));
  // What is within comes before what is beyond.
  if (!_within.empty() && !_beyond.empty() && *_beyond.begin() < *_within.rbegin()) {
    _within.insert(_beyond.extract(_beyond.begin()));
    _beyond.insert(_within.extract(std::prev(_within.end())));
  }
}

void FamilyLimit::erase(const Place& first) {
  if (_within.erase(first) == 0) {
    _beyond.erase(first);
    return;
  }
  if (!_beyond.empty()) _within.insert(_beyond.extract(_beyond.begin()));
}

}  // namespace orbweaver::survey
