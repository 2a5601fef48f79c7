#include "vibe_vision/marker/marker_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::marker_design_test {
namespace {

TEST(MarkerDesign, RingIsBlackBetweenItsDiameters) {
  const RingDesign ring;
  EXPECT_EQ(reflectance(ring, 0, 0), 1);
  EXPECT_EQ(reflectance(ring, 1.5e-3, 0), 0);
  EXPECT_EQ(reflectance(ring, 0, -1.5e-3), 0);
  EXPECT_EQ(reflectance(ring, 1.5e-3, 1.5e-3), 1);
}

TEST(MarkerDesign, BarsGoAroundTheRod) {
  const SleeveDesign sleeve = defaultSleeve();
  for (const Bar& bar : sleeve.bars)
    for (double phi = -3; phi < 3; phi += 0.5) {
      EXPECT_EQ(reflectance(sleeve, (bar.begin + bar.end) / 2, phi), 0);
      EXPECT_EQ(reflectance(sleeve, bar.begin - 1e-5, phi), 1);
      EXPECT_EQ(reflectance(sleeve, bar.end + 1e-5, phi), 1);
    }
}

TEST(MarkerDesign, StripeAdvancesByOnePitchPerTurnAndEndsWithTheHelix) {
  const SleeveDesign sleeve = defaultSleeve();
  EXPECT_EQ(reflectance(sleeve, 0, 0), 0);
  EXPECT_EQ(reflectance(sleeve, 0, M_PI), 1);
  const double step = 0.1;
  for (double u = sleeve.helix_begin + 1e-4; u < sleeve.helix_end - 5e-4; u += 1e-4)
    for (double phi = -3; phi < 3; phi += 0.37)
      EXPECT_EQ(reflectance(sleeve, u, phi),
                reflectance(sleeve, u + sleeve.helix_pitch * step / (2 * M_PI), phi + step));
  EXPECT_EQ(reflectance(sleeve, sleeve.helix_end + 1e-5, 2 * M_PI * sleeve.helix_end / sleeve.helix_pitch), 1);
}

TEST(MarkerDesign, DefaultMarkersAreAccepted) {
  EXPECT_NO_THROW(checkMarker(defaultSleeve(), "here"));
  EXPECT_NO_THROW(checkMarker(RingDesign(), "here"));
}

void expectSentence(const MarkerDesign& design, const std::string& part) {
  const std::string sentence = errorOf([&] { checkMarker(design, "rig.yaml:12"); });
  EXPECT_EQ(sentence.rfind("rig.yaml:12: ", 0), 0U) << sentence;
  EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
}

TEST(MarkerDesign, WrongRingsAreRefused) {
  const auto changed = [](const std::function<void(RingDesign&)>& change) {
    RingDesign ring;
    change(ring);
    return ring;
  };
  expectSentence(changed([](auto& r) { r.outer_diameter = -1e-3; }), "outer diameter is -1 mm");
  expectSentence(changed([](auto& r) { r.inner_diameter = r.outer_diameter; }), "not below its outer diameter, 4 mm");
  expectSentence(changed([](auto& r) { r.side = 4.5e-3; }), "needs at least 5.2 mm");
  expectSentence(changed([](auto& r) { r.side = std::numeric_limits<double>::quiet_NaN(); }), "white square");
}

TEST(MarkerDesign, WrongSleevesAreRefused) {
  const auto changed = [](const std::function<void(SleeveDesign&)>& change) {
    SleeveDesign sleeve = defaultSleeve();
    change(sleeve);
    return sleeve;
  };
  expectSentence(changed([](auto& s) { s.diameter = 0; }), "diameter is 0 mm");
  expectSentence(changed([](auto& s) { s.bars.resize(2); }), "2 bars");
  expectSentence(changed([](auto& s) { std::swap(s.bars[0], s.bars[1]); }), "ascending order");
  expectSentence(changed([](auto& s) { s.bars[1].end = s.bars[1].begin; }), "bar 2 of the sleeve must begin");
  expectSentence(changed([](auto& s) { s.bars.back().end = s.length / 2; }), "white is needed");
  expectSentence(changed([](auto& s) { s.bars[1].end = s.helix_begin + 1e-4; }), "lies in the helix");
  expectSentence(changed([](auto& s) { s.helix_pitch = 0; }), "pitch");
  expectSentence(changed([](auto& s) { s.helix_duty = 1; }), "duty");
  expectSentence(changed([](auto& s) { s.helix_end = s.helix_begin; }), "helix is from");
}

TEST(MarkerDesign, PeriodicBarsAreRefused) {
  SleeveDesign sleeve = defaultSleeve();
  sleeve.bars = {{-4.2e-3, -3.8e-3}, {-3.4e-3, -3.0e-3}, {2.2e-3, 2.6e-3}, {3.0e-3, 3.4e-3}, {3.8e-3, 4.2e-3}};
  expectSentence(sleeve, "look the same after a shift");
}

}  // namespace
}  // namespace vibe::vision::marker_design_test
