#include "cell_counts.hpp"

namespace orbweaver::continuation::cell_counts {

int cutoff_of(const loop::FundamentalDomain& domain, int cells) { return (cells * domain.copies() - 1) / 2; }

int at_least(int cells) {
  // 8, 12, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80, ...: steps of an eighth to a quarter.
  int octave = 16;
  while (octave * 2 < cells) octave *= 2;
  const int step = octave / 4 < 4 ? 4 : octave / 4;
  const int count = (cells + step - 1) / step * step;
  return count < least ? least : count;
}

int next(int cells) { return at_least(cells + 1); }

int previous(int cells) {
  int smaller = cells - 4;
  while (smaller > least && at_least(smaller) != smaller) smaller -= 4;
  return smaller < least ? least : smaller;
}

int at_least_for_cutoff(const loop::FundamentalDomain& domain, int cutoff) {
  const int nodes = 2 * cutoff + 1;
  return at_least((nodes + domain.copies() - 1) / domain.copies());
}

}  // namespace orbweaver::continuation::cell_counts
