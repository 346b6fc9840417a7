#include "orbweaver/core/address_space.hpp"

#include <fstream>
#include <string>

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

// In this order: what OpenBLAS has taken it keeps.
TEST(AddressSpace, ABufferThatDoesNotFitIsRefusedWithTheNumberNeeded) {
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

TEST(AddressSpace, TheBufferIsAsLargeAsItIsSaidToBe) {
  const double before = addresses_now();
  core::take_blas_buffer();
  const double taken = addresses_now() - before;
  EXPECT_GT(taken, 127.0 * mebibyte);
  EXPECT_LT(taken, 129.0 * mebibyte);
  core::take_blas_buffer();
  EXPECT_LT(addresses_now() - before, 129.0 * mebibyte) << "it is taken once";
}

TEST(AddressSpace, LimitsBelowWhatARankTakesAreRefused) {
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
