#include "overlay/drive_overlay.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "offscreen.hpp"

namespace vibe::rviz_plugins::drive_overlay_test {
namespace {

DriveHud exampleHud() {
  DriveHud hud;
  hud.limits = {{{0, 0.3, 0.15},
                 {-3.14, 3.14, 3},
                 {-1.57, 2.86, 3},
                 {-1.75, 1.75, 3},
                 {0, 0.03, 0.1},
                 {-50, 50, 25},
                 {0, 0.018, 0.1}}};
  hud.joints = {0.125, -0.5, 0.6, -0.3, 0.012, 6.3, 0.004};
  hud.force = 1.2;
  hud.pressure = 1300;
  hud.tissue = "not touched";
  hud.needle = "in the exchange";
  hud.bites = "42";
  hud.step = {2, "Hold W to insert the endoscope"};
  return hud;
}

/// Share of the pixels that differ.
double difference(const QImage& a, const QImage& b) {
  EXPECT_EQ(a.size(), b.size());
  int count = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) count += a.pixel(x, y) != b.pixel(x, y);
  return static_cast<double>(count) / (a.width() * a.height());
}

struct DriveOverlayTest : testing::Test {
  DriveOverlayTest() { offscreenApplication(); }
};

TEST_F(DriveOverlayTest, LeavesTheMiddleFree) {
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{900, 620}, std::pair{1280, 720}}) {
    const double scale = overlayScale(width, height);
    const DriveHud hud = exampleHud();
    const QImage keys = drawnKeys(hud, scale), state = drawnState(hud, scale), banner = drawnBanner(hud, scale, width);
    EXPECT_LT(keys.width() + 12, 0.36 * width) << width;
    EXPECT_LT(state.width() + 12, 0.36 * width) << width;
    EXPECT_LT(banner.height() + keys.height() + 24, height) << height;
    EXPECT_LT(banner.height(), 0.12 * height);
    EXPECT_LE(banner.width(), width);
    EXPECT_TRUE(sitBeside(keys, state, width));
  }
  EXPECT_FALSE(sitBeside(drawnKeys(exampleHud(), 0.8), drawnState(exampleHud(), 0.8), 280)) << "a narrow view";
}

/// Whether anything but the plate is drawn in the outermost pixels at the right.
bool reachesTheEdge(const QImage& image) {
  const QRgb plate = image.pixel(image.width() - 2, image.height() / 2);
  for (int y = 10; y < image.height() - 10; ++y)
    for (int x = image.width() - 4; x < image.width() - 1; ++x)
      if (image.pixel(x, y) != plate) return true;
  return false;
}

TEST_F(DriveOverlayTest, NothingIsCut) {
  DriveHud hud = exampleHud();
  hud.joints = {0.3, -3.14, -1.57, -1.75, 0.03, -50.2, 0.018};
  hud.pressure = 13000;
  hud.force = 1000;
  for (const double scale : {0.8, 1.0, 1.29, 1.4}) {
    EXPECT_FALSE(reachesTheEdge(drawnKeys(hud, scale))) << scale;
    EXPECT_FALSE(reachesTheEdge(drawnState(hud, scale))) << scale;
    EXPECT_FALSE(reachesTheEdge(drawnBanner(hud, scale, 900))) << scale;
  }
}

TEST_F(DriveOverlayTest, IsSemiTransparent) {
  const QImage keys = drawnKeys(exampleHud(), 1);
  const int alpha = qAlpha(keys.pixel(keys.width() - 4, keys.height() / 2));
  EXPECT_GT(alpha, 120);
  EXPECT_LT(alpha, 220);
  EXPECT_EQ(qAlpha(keys.pixel(0, 0)), 0) << "round corners";
}

TEST_F(DriveOverlayTest, PressedKeysLightUp) {
  DriveHud hud = exampleHud();
  const QImage before = drawnKeys(hud, 1);
  EXPECT_EQ(difference(before, drawnKeys(hud, 1)), 0);
  for (const operating::KeyBinding& binding : operating::keyBindings()) {
    if (binding.kind == operating::KeyBinding::Kind::Gear) continue;  // stays lit while it is chosen
    hud.keys_down = {binding.key};
    EXPECT_GT(difference(before, drawnKeys(hud, 1)), 1e-4) << "key " << binding.key;
  }
  hud.keys_down.clear();
  hud.gear = operating::DriveGear::Fast;
  EXPECT_GT(difference(before, drawnKeys(hud, 1)), 1e-4) << "gear";
  hud.gear = operating::DriveGear::Normal;
  hud.keys_down = {Qt::Key_M};
  EXPECT_EQ(difference(before, drawnKeys(hud, 1)), 0) << "a key that drives nothing";
}

TEST_F(DriveOverlayTest, StateShowsJointsButtonsForceAndPressure) {
  const DriveHud hud = exampleHud();
  const QImage before = drawnState(hud, 1);
  EXPECT_EQ(difference(before, drawnState(hud, 1)), 0);
  for (std::size_t i = 0; i < hud.joints.size(); ++i) {
    DriveHud other = hud;
    other.joints[i] = hud.limits[i].upper;
    EXPECT_GT(difference(before, drawnState(other, 1)), 1e-4) << "joint " << i;
  }
  for (std::size_t i = 0; i < hud.buttons.size(); ++i) {
    DriveHud other = hud;
    other.buttons[i] = true;
    EXPECT_GT(difference(before, drawnState(other, 1)), 1e-3) << "button " << i;
  }
  DriveHud other = hud;
  other.pressure = 200;
  EXPECT_GT(difference(before, drawnState(other, 1)), 1e-4);
}

/// How many pixels are mostly of the colour of a channel.
int count(const QImage& image, bool (*is)(QRgb)) {
  int number = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) number += is(image.pixel(x, y)) ? 1 : 0;
  return number;
}

TEST_F(DriveOverlayTest, ForceTurnsFromGreenToRed) {
  const auto isGreen = [](QRgb c) { return qGreen(c) > 150 && qRed(c) < 120 && qBlue(c) < 140; };
  const auto isRed = [](QRgb c) { return qRed(c) > 190 && qGreen(c) < 110; };
  DriveHud hud = exampleHud();
  hud.force = 4;
  EXPECT_GT(count(drawnState(hud, 1), isGreen), 20);
  EXPECT_EQ(count(drawnState(hud, 1), isRed), 0);
  hud.force = 6;
  EXPECT_EQ(count(drawnState(hud, 1), isGreen) + count(drawnState(hud, 1), isRed), 0);
  hud.force = 9;
  EXPECT_EQ(count(drawnState(hud, 1), isGreen), 0);
  EXPECT_GT(count(drawnState(hud, 1), isRed), 40);
  hud.force = std::nan("");
  EXPECT_EQ(count(drawnState(hud, 1), isGreen), 0) << "unknown";
}

TEST_F(DriveOverlayTest, TroubleReplacesTheStep) {
  DriveHud hud = exampleHud();
  const QImage step = drawnBanner(hud, 1, 640);
  hud.trouble = "No simulator publishes /procedure/state. Start one, or set 'Namespace'.";
  const QImage trouble = drawnBanner(hud, 1, 640);
  EXPECT_NE(step.width(), trouble.width());
  EXPECT_GT(qRed(trouble.pixel(trouble.width() - 5, trouble.height() / 2)), 100);
  EXPECT_LE(drawnBanner(hud, 1, 300).width(), 300) << "a long sentence is broken";
  EXPECT_GT(drawnBanner(hud, 1, 300).height(), trouble.height());
}

}  // namespace
}  // namespace vibe::rviz_plugins::drive_overlay_test
