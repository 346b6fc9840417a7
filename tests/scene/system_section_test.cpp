#include "system_section.hpp"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/document/document.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::scene::system_section_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two drives share their frequency.
systems::ModelInfo damped_pendulum() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  systems::ModelInfo info;
  info.name = "damped_pendulum";
  info.parameters = {{"l", 1.0, 0.0, infinity, true, "m", "length"}};
  const systems::Parameter frequency{"w", 1.0, 0.0, infinity, true, "rad/s", "frequency"};
  info.effects = {{"friction", "drag at the pivot", {{"c", 0.1, 0.0, 2.0, false, "1/s", "damping rate"}}},
                  {"shaking", "the pivot shaken", {frequency}},
                  {"torque", "a motor", {frequency}}};
  return info;
}

void read(const std::string& text) {
  const Source source("scene.yaml", {});
  SystemChoice choice;
  read_parameters(Field(source, parse_document(text, "scene.yaml", true), "system.parameters", 1), damped_pendulum(),
                  choice);
}

TEST(SystemSection, AParameterOfTwoEffectsComesWithEither) {
  const Source source("scene.yaml", {});
  const Field field(source, parse_document("{w: 2}", "scene.yaml", true), "system.parameters", 1);
  SystemChoice choice;
  choice.effects = {"torque"};
  EXPECT_THAT(known_parameters(damped_pendulum(), choice), testing::SizeIs(2));
  choice.effects = {"shaking", "torque"};
  EXPECT_THAT(known_parameters(damped_pendulum(), choice), testing::SizeIs(2));
  EXPECT_THAT([] { read("{w: 2}"); }, ThrowsMessage<core::InputError>(HasSubstr("one of the effect `shaking`")));
}

TEST(SystemSection, AParameterWithoutItsEffectIsSaidToBeOne) {
  EXPECT_THAT([] { read("{c: 0.1}"); }, ThrowsMessage<core::InputError>(
                                            AllOf(HasSubstr("scene.yaml:1: system.parameters.c: expected a parameter"),
                                                  HasSubstr("got one of the effect `friction`, which is not"),
                                                  HasSubstr("add `effects: [friction]`, or remove it"))));
  EXPECT_THAT([] { read("{d: 0.1}"); }, ThrowsMessage<core::InputError>(HasSubstr("unknown key")));
}

}  // namespace
}  // namespace orbweaver::scene::system_section_test
