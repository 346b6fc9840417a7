#include "grid/known_plans.hpp"

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <fftw3.h>
#include <gtest/gtest.h>

namespace orbweaver::loop::known_plans_test {
namespace {

bool has_small_factors(int n) {
  for (const int p : {2, 3, 5, 7})
    while (n % p == 0) n /= p;
  return n == 1;
}

std::string text_of(fftw_plan plan) {
  const std::unique_ptr<char, decltype(&std::free)> text(fftw_sprint_plan(plan), &std::free);
  fftw_destroy_plan(plan);
  return text.get();
}

/// The algorithms that FFTW chooses, there and back.
std::string plans_of(int n, int copies) {
  const std::unique_ptr<double, decltype(&fftw_free)> real(fftw_alloc_real(static_cast<std::size_t>(n * copies)),
                                                           &fftw_free);
  const int half = n / 2 + 1;
  const std::unique_ptr<fftw_complex, decltype(&fftw_free)> complex(
      fftw_alloc_complex(static_cast<std::size_t>(half * copies)), &fftw_free);
  if (copies == 1)
    return text_of(fftw_plan_dft_r2c_1d(n, real.get(), complex.get(), FFTW_ESTIMATE)) +
           text_of(fftw_plan_dft_c2r_1d(n, complex.get(), real.get(), FFTW_ESTIMATE));
  return text_of(fftw_plan_many_dft_r2c(1, &n, copies, real.get(), nullptr, 1, n, complex.get(), nullptr, 1, half,
                                        FFTW_ESTIMATE)) +
         text_of(fftw_plan_many_dft_c2r(1, &n, copies, complex.get(), nullptr, 1, half, real.get(), nullptr, 1, n,
                                        FFTW_ESTIMATE));
}

void tell_all() {
  for (const KnownPlans& known : known_plans())
    ASSERT_EQ(fftw_import_wisdom_from_string(known.wisdom), 1) << "FFTW is not the one of the build";
}

TEST(KnownPlans, CoverTheSizesInUseInOrder) {
  int next = 2;
  for (const KnownPlans& known : known_plans()) {
    EXPECT_EQ(known.from, next);
    EXPECT_GT(known.to, known.from);
    next = known.to + 2;
  }
  EXPECT_GE(next, 8192);
}

// An archive's bits rest on this: what is known changes no plan, neither of its own sizes nor of others.
TEST(KnownPlans, AreThoseThatFftwFindsByItself) {
  std::map<std::pair<int, int>, std::string> found;
  for (const int copies : {1, 4, 6})
    for (int n = 2; n <= 10000; n += n < 120 ? 1 : 2) {
      if (n > 120 && !has_small_factors(n)) continue;
      if (copies > 1 && n > 2100 && n % 1024 != 0) continue;
      fftw_forget_wisdom();
      found[{n, copies}] = plans_of(n, copies);
    }
  fftw_forget_wisdom();
  tell_all();
  for (const auto& [place, plans] : found)
    EXPECT_EQ(plans_of(place.first, place.second), plans) << place.first << " nodes, " << place.second << " at once";
}

TEST(KnownPlans, AreToldOnce) {
  const int nodes = known_plans().back().from;  // of sizes that no other test of the program has
  fftw_forget_wisdom();
  recall_plans(nodes);
  const std::unique_ptr<char, decltype(&std::free)> told(fftw_export_wisdom_to_string(), &std::free);
  EXPECT_GT(std::string(told.get()).size(), 1000u);
  fftw_forget_wisdom();
  recall_plans(nodes);
  const std::unique_ptr<char, decltype(&std::free)> again(fftw_export_wisdom_to_string(), &std::free);
  EXPECT_LT(std::string(again.get()).size(), 200u);
}

}  // namespace
}  // namespace orbweaver::loop::known_plans_test
