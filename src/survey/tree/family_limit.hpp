#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace orbweaver::survey {

/// Which branches belong to the first families, as many as the scene allows, in the order of depth, then key.
class FamilyLimit {
 public:
  /// A branch's place in the order.
  using Place = std::pair<int, std::string>;

  explicit FamilyLimit(int most) : _most(most > 0 ? static_cast<std::size_t>(most) : 0) {}

  /// A branch of `family` counts, or counts no more.
  void count(const Place& place, const std::string& family, bool counts);
  /// Whether a branch here is one of a family that has begun before it, or fewer than all families have.
  [[nodiscard]] bool has_room(const Place& place, const std::string& family) const;

 private:
  void insert(const Place& first);
  void erase(const Place& first);

  std::size_t _most;
  std::map<std::string, std::set<Place>> _branches;  // by family
  std::set<Place> _within;                           // the first branches of the first families, at most _most
  std::set<Place> _beyond;                           // of the others
};

}  // namespace orbweaver::survey
