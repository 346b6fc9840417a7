// A model that a program has in C++, and what names and meanings may be.
#include "orbweaver/systems/recorded_model.hpp"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::systems::recorded_model_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

ModelInfo info_with(const std::string& name, const std::string& meaning) {
  ModelInfo info;
  info.name = name;
  info.meaning = meaning;
  info.state_names = {"q", "p"};
  info.winding_names = {"", ""};
  info.parameters = {{"k", 1.0, 0.0, 2.0, false, "1", meaning}};
  return info;
}

/// H = p^2/2 + k q^2/2 + q^4/3.
class Hardening {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 1;
  static ModelInfo info() { return info_with("hardening", "a mass on a spring that hardens"); }
  static Structure structure(const Bound&) {
    Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _k(bound["k"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = -z[0] * _k - S(4.0) / 3.0 * z[0] * z[0] * z[0];
    }
    template <int, class S>
    S conserved(const S* z) const {
      return (z[1] * z[1] + z[0] * z[0] * _k) * 0.5 + z[0] * z[0] * z[0] * z[0] / 3.0;
    }
    template <class S>
    S action_density(const S* z) const {
      return z[1] * z[1];
    }

   private:
    P _k;
  };
};

/// The same as text.
const char* const hardening_text =
    "{name: hardening_text, coordinates: [q], momenta: [p], hamiltonian: p^2/2 + k*q^2/2 + q^4/3, parameters: {k: 1}}";

TEST(RecordedModel, IsASystemByItsNameAsItsTextIs) {
  add_recorded<Hardening>();
  EXPECT_THAT(system_names(), testing::Contains("hardening"));
  add_model(read_model_text(hardening_text, "hardening.yaml"));
  const auto recorded = make_system("hardening", {{"k", 1.5}});
  const auto read = make_system("hardening_text", {{"k", 1.5}});
  EXPECT_TRUE(recorded->structure().symplectic);
  const std::vector<double> z{0.75, 0.5};
  std::vector<double> f(2), g(2), jacobian(4), other(4);
  recorded->field_jacobian(1, z.data(), f.data(), jacobian.data());
  read->field_jacobian(1, z.data(), g.data(), other.data());
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_DOUBLE_EQ(f[i], g[i]);
  for (std::size_t i = 0; i < other.size(); ++i) EXPECT_DOUBLE_EQ(jacobian[i], other[i]);
  EXPECT_DOUBLE_EQ(recorded->conserved(0, z), read->conserved(0, z));
  EXPECT_EQ(recorded->action_density(z), 0.25);
  EXPECT_THROW(static_cast<void>(make_system("hardening", {{"k", 3.0}})), core::InputError);
}

TEST(RecordedModel, HasANameOfItsOwn) {
  EXPECT_THAT([] { add_recorded(info_with("lorenz", ""), recorded<Hardening>); },
              ThrowsMessage<core::InputError>(HasSubstr("a system of the program named 'lorenz'")));
  EXPECT_THROW(add_recorded(info_with("a\nb", ""), recorded<Hardening>), core::InputError);
}

TEST(Description, NamesItsPartsOnceAndFinitely) {
  const auto refused = [](const ModelInfo& info, const char* why) {
    EXPECT_THAT([&] { require_description(info); }, ThrowsMessage<core::InputError>(HasSubstr(why)));
  };
  ModelInfo info = info_with("mine", "");
  info.state_names = {"q", "q"};
  refused(info, "two of its coordinates are named `q`");
  info = info_with("mine", "");
  info.parameters.push_back(info.parameters.front());
  refused(info, "two of its parameters are named `k`");
  info = info_with("mine", "");
  info.parameters.front().standard = std::numeric_limits<double>::quiet_NaN();
  refused(info, "its parameter `k` has the standard value nan");
  info = info_with("mine", "");
  for (int n = 0; n < 100'000; ++n) {
    info.parameters.push_back(info.parameters.front());
    info.parameters.back().name = "k" + std::to_string(n);
  }
  refused(info, "its 100001 parameters are more than an archive's head holds: expected at most 7500");
}

TEST(Description, IsOneLineOfText) {
  EXPECT_NO_THROW(require_description(info_with("mine", "Schwünge")));
  EXPECT_NO_THROW(require_description(info_with("mine", "")));
  for (const std::string& wrong : {std::string("\x1b[31m"), std::string("\xff"), std::string("a\nb"),
                                   std::string("a\0b", 3), std::string(1000, 'x')}) {
    EXPECT_THROW(require_description(info_with(wrong, "")), core::InputError) << wrong;
    EXPECT_THROW(require_description(info_with("mine", wrong)), core::InputError) << wrong;
  }
  EXPECT_THROW(require_description(info_with("", "")), core::InputError);
  ModelInfo nameless = info_with("mine", "");
  nameless.state_names[1].clear();
  EXPECT_THROW(require_description(nameless), core::InputError);
}

}  // namespace
}  // namespace orbweaver::systems::recorded_model_test
