#pragma once
#include <QImage>
#include <limits>
#include <string>

#include "vibe_operator/drive/drive_keys.hpp"
#include "vibe_operator/driving/scope_sender.hpp"

namespace vibe::rviz_plugins {

/// What the overlay of the tool 'Drive scope' shows.
struct DriveHud : operating::DriveView {
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< gauge [Pa]; NaN: unknown
  std::string tissue, needle, bites;  ///< what the tool does, where the needle is, how many bites: a few words each
};

// Images with transparent parts. `scale` 1 suits a view of 640 x 480 pixels.

/// The table of keys.
QImage drawnKeys(const DriveHud& hud, double scale);
/// Joints, force, pressure, what the tool does, and buttons.
QImage drawnState(const DriveHud& hud, double scale);
/// One line: the trouble, or the next step. Not wider than `width` pixels; a longer sentence is broken.
QImage drawnBanner(const DriveHud& hud, double scale, int width);

/// Scale of the overlay in a view of this size [pixels]: the panels at the sides leave the middle free.
double overlayScale(int width, int height);

/// Whether both panels fit into a view of this width [pixels] with a gap between them. If not, the keys are shown.
bool sitBeside(const QImage& keys, const QImage& state, int width);

}  // namespace vibe::rviz_plugins
