#pragma once
#ifndef Q_MOC_RUN
#include <rviz/panel.h>
#endif

namespace vibe::rviz_plugins {

class ProcedureWidget;

/// The cockpit as a panel of rviz. Keeps the namespace in rviz's configuration.
class ProcedurePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ProcedurePanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  ProcedureWidget* widget_;
};

}  // namespace vibe::rviz_plugins
