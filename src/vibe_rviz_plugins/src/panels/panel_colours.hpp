#pragma once
#include <QColor>
#include <QIcon>
#include <QPalette>

#include "messages/event_lines.hpp"
#include "messages/reference_values.hpp"

namespace vibe::rviz_plugins {

/// Colours and symbols of the panel, legible with light and dark styles. No meaning depends on colour alone: every
/// symbol has its own shape.

QColor goodColour(const QPalette& palette);
QColor warningColour(const QPalette& palette);
QColor dangerColour(const QPalette& palette);
QColor quietColour(const QPalette& palette);

QColor colourOf(EventSeverity severity, const QPalette& palette);
QColor colourOf(Rating rating, const QPalette& palette);

/// Circle: note; tick: success; triangle: warning; drop: bleeding; cross in a square: harm.
QIcon symbolOf(EventSeverity severity, const QPalette& palette);

/// A lamp, filled while it is on.
QIcon lamp(bool on, const QPalette& palette);

}  // namespace vibe::rviz_plugins
