// check_tree ATLAS [--failures N] [--base-families N]: whether the families of a survey make a sound tree
// (tree_problems.hpp). Ends with 1 and a line a problem where they do not.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "tree_problems.hpp"

int main(int argc, char** argv) {
  using namespace orbweaver;
  test::TreeOptions options;
  bool understood = argc >= 2 && argc % 2 == 0;
  for (int i = 2; understood && i < argc; i += 2) {
    const std::string word = argv[i];
    if (word == "--failures")
      options.failures = static_cast<std::size_t>(std::atoi(argv[i + 1]));
    else if (word == "--base-families")
      options.base_families = std::atoi(argv[i + 1]);
    else
      understood = false;
  }
  if (!understood) {
    std::fputs("usage: check_tree ATLAS [--failures N] [--base-families N]\n", stderr);
    return 2;
  }
  const archive::Archive atlas(argv[1]);
  const std::vector<std::string> problems = test::tree_problems(atlas, options);
  for (const std::string& problem : problems) fmt::print("{}\n", problem);
  fmt::print("{} families, {} orbits, {} crossings: {} problems\n", atlas.families().rows(), atlas.orbits().rows(),
             atlas.crossings().rows(), problems.size());
  return problems.empty() ? 0 : 1;
}
