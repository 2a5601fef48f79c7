#pragma once

#include <QWidget>
#include <memory>

#include "panels/panel_messages.hpp"
#include "vibe_operator/messages/procedure_text.hpp"

class QLabel;

namespace vibe::rviz_plugins {

/// The procedure's phases from left to right. The present one is filled, framed and bold, those behind are
/// underlined.
class PhaseStrip : public QWidget {
 public:
  explicit PhaseStrip(QWidget* parent = nullptr);

  void display(const std::array<operating::PhaseStep, operating::kPhaseCount>& steps);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::array<operating::PhaseStep, operating::kPhaseCount> steps_;

  double minWidth(const QFont& face) const;  // without clipping [px]
  QFont fittingFont() const;                 // smaller where there is no room for the whole
  void paintStep(QPainter& painter, const QRectF& place, const operating::PhaseStep& step) const;
};

class RangeBar;
class TextRows;

/// What matters at a glance: scene and time, phase, what the tool does, how many bites, whether anything bleeds, how
/// hard the tissue pulls, marks and burns.
class StatusSummary : public QWidget {
 public:
  explicit StatusSummary(QWidget* parent = nullptr);
  ~StatusSummary() override;

  void display(const PanelMessages& messages);

 private:
  QLabel* header_;
  PhaseStrip* phases_;
  RangeBar* force_bar_;
  std::unique_ptr<TextRows> rows_;

  void displayState(const PanelMessages& messages);
  void displaySkill(const PanelMessages& messages);
  void displayBleeding(const PanelMessages& messages);
  void displayForce(const PanelMessages& messages);
};

}  // namespace vibe::rviz_plugins
