#pragma once
#include <QWidget>
#include <memory>

#include "panels/panel_messages.hpp"

class QLabel;

namespace vibe::rviz_plugins {

class PhaseStrip;
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
