#include "orbweaver/core/address_space.hpp"

#include <fstream>
#include <string>

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "orbweaver/core/error.hpp"

namespace address_space_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double mebibyte = 1 << 20;

double addresses_now() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmSize:")) return 1024.0 * std::stod(line.substr(7));
  return 0.0;
}

/// A limit of this process, while the object stands.
class Limited {
 public:
  Limited(__rlimit_resource kind, double bytes) : _kind(kind) {
    getrlimit(_kind, &_before);
    rlimit limit = _before;
    limit.rlim_cur = static_cast<rlim_t>(bytes);
    setrlimit(_kind, &limit);
  }
  ~Limited() { setrlimit(_kind, &_before); }
  Limited(const Limited&) = delete;
  Limited& operator=(const Limited&) = delete;

 private:
  __rlimit_resource _kind;
  rlimit _before{};
};

/// The program has PETSc, and with it BLAS, which nothing here calls.
class AddressSpace : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ASSERT_NE(dlopen("libblas.so.3", RTLD_NOW | RTLD_GLOBAL), nullptr) << dlerror(); }
};

// In this order: what OpenBLAS has taken it keeps.
TEST_F(AddressSpace, ABufferThatDoesNotFitIsRefusedWithTheNumberNeeded) {
  const double before = addresses_now();
  for (const auto kind : {RLIMIT_AS, RLIMIT_DATA}) {
    const Limited limited(kind, kind == RLIMIT_AS ? before + 64.0 * mebibyte : 64.0 * mebibyte);
    try {
      core::take_blas_buffer();
      ADD_FAILURE() << "128 MiB where 64 are left";
    } catch (const core::EnvironmentError& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr(kind == RLIMIT_AS ? "`ulimit -v " : "`ulimit -d "), HasSubstr("128 MiB")));
    }
  }
  EXPECT_LT(addresses_now(), before + 64.0 * mebibyte);
}

TEST_F(AddressSpace, TheBufferIsAsLargeAsItIsSaidToBe) {
  const double before = addresses_now();
  core::take_blas_buffer();
  const double taken = addresses_now() - before;
  EXPECT_GT(taken, 127.0 * mebibyte);
  EXPECT_LT(taken, 129.0 * mebibyte);
  core::take_blas_buffer();
  EXPECT_LT(addresses_now() - before, 129.0 * mebibyte) << "it is taken once";
}

TEST_F(AddressSpace, LimitsBelowWhatARankTakesAreRefused) {
  EXPECT_NO_THROW(core::require_space_of_a_rank());
  const double least = core::space_of_a_rank().addresses;
  {
    const Limited enough(RLIMIT_AS, least + mebibyte);
    EXPECT_NO_THROW(core::require_space_of_a_rank());
  }
  const Limited limited(RLIMIT_AS, least - mebibyte);
  EXPECT_THROW(core::require_space_of_a_rank(), core::EnvironmentError);
}

}  // namespace
}  // namespace address_space_test
