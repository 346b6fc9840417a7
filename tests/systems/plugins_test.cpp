#include "orbweaver/systems/plugins.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <unistd.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"
#include "registry_lines.hpp"
#include "shared_library.hpp"

namespace orbweaver::systems::plugins_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A file that begins as this program, which is laid out as shared libraries are.
class SharedLibrary : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    whole = (std::ostringstream() << program.rdbuf()).str();
  }
  void TearDown() override { std::filesystem::remove(file); }

  [[nodiscard]] auto reading(const std::string& bytes) const {
    std::ofstream(file, std::ios::binary) << bytes;
    return [this] { require_shared_library(file); };
  }

  const std::filesystem::path file = "library_" + std::to_string(getpid()) + ".so";
  std::string whole;
};

TEST_F(SharedLibrary, IsTakenWhole) { EXPECT_NO_THROW(reading(whole)()); }

TEST_F(SharedLibrary, IsRefusedTorn) {
  for (const std::size_t size : {std::size_t{70}, whole.size() / 100, whole.size() / 2})
    EXPECT_THAT(reading(whole.substr(0, size)), ThrowsMessage<core::InputError>(HasSubstr("it is torn"))) << size;
  EXPECT_THAT([&] { static_cast<void>(load_plugin(file)); },
              ThrowsMessage<core::InputError>(HasSubstr("cannot be loaded (it is torn")));
}

TEST_F(SharedLibrary, IsRefusedForAnotherMachineOrKind) {
  constexpr std::size_t place_of_class = 4, place_of_type = 16, place_of_machine = 18;
  for (const std::size_t place : {place_of_class, place_of_machine}) {
    std::string other = whole;
    other[place] = static_cast<char>(other[place] ^ 0x40);
    EXPECT_THAT(reading(other), ThrowsMessage<core::InputError>(HasSubstr("for another machine"))) << place;
  }
  std::string other = whole;
  other[place_of_type] = 1;
  EXPECT_THAT(reading(other), ThrowsMessage<core::InputError>(HasSubstr("it is no shared library")));
  EXPECT_THAT(reading(""), ThrowsMessage<core::InputError>(HasSubstr("it is no shared library")));
  EXPECT_THAT(reading("system: {}\n"), ThrowsMessage<core::InputError>(HasSubstr("it is no shared library")));
}

ModelInfo info_with(const std::string& name, const std::string& meaning) {
  ModelInfo info;
  info.name = name;
  info.meaning = meaning;
  info.state_names = {"q", "p"};
  info.winding_names = {"", ""};
  info.parameters = {{"k", 1.0, 0.0, 2.0, false, "1", meaning}};
  return info;
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

TEST(PluginSystem, ThatContradictsItselfIsWrongInput) {
  static const ModelInfo info = info_with("contradicts_itself", "");
  const std::array lines{RegistryLine{
      []() -> const ModelInfo& { return info; },
      [](const Bound&) -> std::shared_ptr<const System> { throw core::MisuseError("as many coordinates"); }}};
  add_registry_lines(lines);
  EXPECT_THAT([] { static_cast<void>(make_system("contradicts_itself")); },
              ThrowsMessage<core::InputError>(HasSubstr("the plugin's system 'contradicts_itself': ")));
}

}  // namespace
}  // namespace orbweaver::systems::plugins_test
