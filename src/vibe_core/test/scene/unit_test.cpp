#include "vibe_core/scene/unit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::unit_test {
namespace {

struct Example {
  const char* text;
  const char* unit;
  double value;
};

TEST(Unit, ConvertsToSi) {
  const Example examples[] = {
      {"10 mmHg", "Pa", 1333.22387415},
      {"36 mL", "m^3", 36e-6},
      {"0.75 L", "m^3", 0.75e-3},
      {"2.3 mm", "m", 2.3e-3},
      {"3 L/min", "m^3/s", 5e-5},
      {"60 kPa", "Pa", 60e3},
      {"4 cm", "m", 0.04},
      {"90 deg", "rad", M_PI / 2},
      {"270 N cm^2", "N m^2", 0.027},
      {"270 N * cm ^2", "N*m^2", 0.027},
      {"2 N / mm", "N/m", 2000},
      {"8 N", "N", 8},
      {"30 1/s", "1/s", 30},
      {"8 Hz", "1/s", 8},
      {"16.7 ms", "s", 0.0167},
      {"1.05 g/cm^3", "kg/m^3", 1050},
      {"45 %", "1", 0.45},
      {"5 kPa/m", "Pa/m", 5000},
      {"5 N/cm^3", "Pa/m", 5e6},
      {"9.81 N/kg", "m/s^2", 9.81},
      {"3 turns", "rad", 6 * M_PI},
      {"10cmH2O", "Pa", 980.665},
      {"-2 cm/s", "m/s", -0.02},
      {"+3 mm", "m", 3e-3},
      {" 7 ", "m", 7},
      {"1e-3", "Pa", 1e-3},
      {"250 µm", "m", 250e-6},
      {"2 h", "s", 7200},
      {"1 N*s/m^2", "Pa*s", 1},
      {"30 deg/s", "rad/s", M_PI / 6},
      {"10 px/mm", "px/m", 1e4},
      {"363.5 px", "px", 363.5},
      {"20 DN", "DN", 20},
      {"2 1/m", "1/m", 2},
  };
  for (const Example& example : examples) {
    const Quantity result = parseQuantity(example.text, example.unit);
    EXPECT_EQ(result.problem, "") << example.text;
    EXPECT_NEAR(result.value, example.value, 1e-12 * std::abs(example.value)) << example.text;
  }
}

TEST(Unit, PlainNumbersKeepTheirBits) {
  EXPECT_EQ(parseQuantity("0.1", "m").value, 0.1);
  EXPECT_EQ(parseQuantity("0.016666666666666666", "s").value, 1.0 / 60);
  EXPECT_EQ(parseQuantity("5e-324", "m").value, 5e-324);
}

TEST(Unit, WrongDimensionNamesWhatItIsAndWhatItMustBe) {
  const std::string problem = parseQuantity("10 mm", "Pa").problem;
  EXPECT_NE(problem.find("a length"), std::string::npos) << problem;
  EXPECT_NE(problem.find("a pressure"), std::string::npos) << problem;
  EXPECT_NE(problem.find("10 mmHg"), std::string::npos) << problem;
  EXPECT_NE(parseQuantity("5 mm", "rad").problem, "");  // angle is a dimension of its own
  EXPECT_NE(parseQuantity("5 rad", "1").problem, "");
  EXPECT_NE(parseQuantity("5 1/s^2", "1/s").problem, "");
}

TEST(Unit, RefusesWhatIsNoFiniteNumber) {
  for (const char* text :
       {"",    " ",     "mm",   "nan",      ".nan",    "inf",    "-.inf", "NaN mm", "1e999",  "--3",  "+-3",
        "1,5", "1.5.2", "0x10", "1e308 km", "3 mm mm", "3 mm^9", "3 mm^", "3 /s",   "3 m//s", "3 m/", "3 parsec"}) {
    EXPECT_NE(parseQuantity(text, "m").problem, "") << text;
  }
  EXPECT_NE(parseQuantity("1e308 kN", "N").problem, "");  // overflows only in SI
  EXPECT_NE(parseQuantity("3 " + std::string(100000, 'm'), "m").problem, "");
}

TEST(Unit, EveryMeasuredSiUnitIsItselfAUnitOfFactorOne) {
  for (const char* unit : {"1", "m", "m^3", "s", "1/s", "kg", "kg/m^3", "N", "Pa", "Pa/m", "m^3/s", "m/s", "m/s^2",
                           "rad", "rad/s", "1/m", "px", "px/m", "DN"}) {
    ASSERT_TRUE(parseUnit(unit)) << unit;
    EXPECT_EQ(parseUnit(unit)->factor, 1) << unit;
  }
}

}  // namespace
}  // namespace vibe::unit_test
