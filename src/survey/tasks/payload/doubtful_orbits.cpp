#include "doubtful_orbits.hpp"

#include <algorithm>

namespace orbweaver::survey {

void add(std::vector<DoubtfulOrbits>& doubtful, const DoubtfulOrbits& orbits) {
  const certificate::Judgement& here = orbits.worst;
  if (here.verdict == certificate::Verdict::holds) return;
  const auto same = std::find_if(doubtful.begin(), doubtful.end(),
                                 [&](const DoubtfulOrbits& d) { return d.worst.verdict == here.verdict; });
  if (same == doubtful.end()) {
    doubtful.push_back(orbits);
    return;
  }
  same->count += orbits.count;
  if (here.found * same->worst.allowed > same->worst.found * here.allowed) same->worst = here;
}

}  // namespace orbweaver::survey
