#include "panels/procedure_panel.hpp"

#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include "panels/procedure_widget.hpp"

namespace vibe::rviz_plugins {

ProcedurePanel::ProcedurePanel(QWidget* parent) : rviz::Panel(parent), widget_(new ProcedureWidget) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(widget_);
  widget_->onNamespaceChanged([this] { Q_EMIT configChanged(); });
}

void ProcedurePanel::onInitialize() {
  widget_->start();
}

void ProcedurePanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString name;
  if (config.mapGetString("Namespace", &name)) widget_->setNamespace(name);
}

void ProcedurePanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Namespace", widget_->nameSpace());
}

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::ProcedurePanel, rviz::Panel)
