#pragma once
#include <QWidget>
#include <memory>

#include "panels/panel_messages.hpp"

namespace vibe::rviz_plugins {

class TextRows;

/// Solver times, real-time factor and latency.
class SolverStatisticsView : public QWidget {
 public:
  explicit SolverStatisticsView(QWidget* parent = nullptr);
  ~SolverStatisticsView() override;

  void display(const PanelMessages& messages, const Freshness& freshness);

 private:
  std::unique_ptr<TextRows> rows_;
};

}  // namespace vibe::rviz_plugins
