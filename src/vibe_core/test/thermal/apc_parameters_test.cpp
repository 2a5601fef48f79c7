#include "vibe_core/thermal/argon_beam.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "vibe_testing/expect_error.hpp"

namespace vibe::apc_parameters_test {
namespace {

TEST(ApcParameters, SayWhatIsOutOfRange) {
  ApcParameters parameters;
  EXPECT_NO_THROW(parameters.check());
  parameters.spot_radius = 0;
  EXPECT_ERROR(parameters.check(), "marking.spot_radius");
  parameters = ApcParameters{};
  parameters.power = std::numeric_limits<double>::quiet_NaN();
  EXPECT_ERROR(parameters.check(), "marking.power");
  parameters = ApcParameters{};
  parameters.burn_energy = parameters.mark_energy / 2;
  EXPECT_ERROR(parameters.check(), "marking.burn_energy");
}

}  // namespace
}  // namespace vibe::apc_parameters_test
