// fourier_plans FILE: writes the source of loop::known_plans (src/loop/grid/known_plans.hpp). Run once, by the build.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>

#include <fftw3.h>

namespace {

// Told to FFTW a range at a time: a survey of few harmonics reads the first only.
constexpr std::array ranges{std::pair{2, 512}, std::pair{514, 2048}, std::pair{2050, 8192}};

bool has_small_factors(int n) {
  for (const int p : {2, 3, 5, 7})
    while (n % p == 0) n /= p;
  return n == 1;
}

void plan(int nodes) {
  double* real = fftw_alloc_real(static_cast<std::size_t>(nodes));
  fftw_complex* complex = fftw_alloc_complex(static_cast<std::size_t>(nodes) / 2 + 1);
  fftw_destroy_plan(fftw_plan_dft_r2c_1d(nodes, real, complex, FFTW_ESTIMATE));
  fftw_destroy_plan(fftw_plan_dft_c2r_1d(nodes, complex, real, FFTW_ESTIMATE));
  fftw_free(real);
  fftw_free(complex);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return EXIT_FAILURE;
  std::ofstream file(argv[1]);
  file << "// Made by fourier_plans (cmake/fourier_plans.cpp).\n#include \"grid/known_plans.hpp\"\n\n"
          "namespace orbweaver::loop {\n\nnamespace {\n\nconstexpr KnownPlans known[]{\n";
  for (const auto& [from, to] : ranges) {
    fftw_forget_wisdom();
    for (int nodes = from; nodes <= to; nodes += 2)
      if (has_small_factors(nodes)) plan(nodes);
    char* wisdom = fftw_export_wisdom_to_string();
    if (wisdom == nullptr) return EXIT_FAILURE;
    file << "    {" << from << ", " << to << ", R\"(" << wisdom << ")\"},\n";
    std::free(wisdom);
  }
  file << "};\n\n}  // namespace\n\nstd::span<const KnownPlans> known_plans() { return known; }\n\n"
          "}  // namespace orbweaver::loop\n";
  file.close();
  return file ? EXIT_SUCCESS : EXIT_FAILURE;
}
