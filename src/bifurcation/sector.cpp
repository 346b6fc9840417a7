#include "orbweaver/bifurcation/sector.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

double Sector::index() const {
  // Exact where the cosine is rational.
  switch (q) {
    case 1: return 2.0;
    case 2: return -2.0;
    case 3: return -1.0;
    case 4: return 0.0;
    case 6: return 1.0;
    default: return 2.0 * std::cos(2.0 * std::numbers::pi * j / q);
  }
}

int Sector::multiplicity(int fundamental_order) const { return q / std::gcd(q, fundamental_order); }

std::vector<Sector> sectors(int fundamental_order, int subharmonics) {
  core::require(fundamental_order >= 1 && subharmonics >= 1,
                "sectors: the fundamental map's order and the number of subharmonics must be at least 1");
  std::vector<Sector> found;
  for (int q = 1; q <= fundamental_order * subharmonics; ++q)
    for (int j = 0; 2 * j <= q; ++j) {
      const Sector sector{q, j};
      if (std::gcd(j, q) == 1 && sector.multiplicity(fundamental_order) <= subharmonics) found.push_back(sector);
    }
  return found;
}

}  // namespace orbweaver::bifurcation
