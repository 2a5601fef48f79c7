#pragma once

#include <QWidget>

#ifndef Q_MOC_RUN
#include <rviz/panel.h>

#include "panels/procedure_subscriptions.hpp"
#include "panels/service_caller.hpp"
#include "vibe_operator/driving/button_sender.hpp"
#endif

class QLabel;
class QLineEdit;
class QPushButton;
class QVBoxLayout;

namespace vibe::rviz_plugins {

class CommandBox;
class EventList;
class StatusSummary;
class MeasuresView;
class SolverStatisticsView;
class RecordBox;
class SteppingBox;
class SutureTable;

/// The whole panel: its parts in a scroll area, the messages they show, and the actions of the buttons. Needs
/// ros::init(), but not rviz.
class ProcedureWidget : public QWidget {
 public:
  explicit ProcedureWidget(QWidget* parent = nullptr);
  ~ProcedureWidget() override;

  /// Sets the namespace of the simulator; empty: that of this program. An invalid one is rejected with a sentence, and
  /// the present one stays.
  void setNamespace(const QString& name);
  QString nameSpace() const { return name_space_; }
  /// Called when the user has chosen another namespace.
  void onNamespaceChanged(std::function<void()> changed) { namespace_changed_ = std::move(changed); }

  /// Starts to subscribe and to display.
  void start();
  /// Updates the display now; otherwise it is updated ten times a second.
  void refresh();

  QSize sizeHint() const override;

 private:
  QString name_space_;
  std::function<void()> namespace_changed_;
  QLabel* status_;
  StatusSummary* summary_;
  CommandBox* commands_;
  SteppingBox* stepping_;
  RecordBox* recording_;
  SutureTable* sutures_;
  QLabel* trainee_;
  MeasuresView* measures_;
  EventList* events_;
  SolverStatisticsView* solver_statistics_;
  QLineEdit* name_space_edit_;
  std::string waited_for_;  // full name of the service that is being called; empty: none
  double waits_since_ = 0;  // [s]
  bool gives_up_ = false;
  std::string wrong_namespace_;
  ProcedureSubscriptions subscriptions_;
  operating::ButtonSender sender_{"procedure_panel"};
  ServiceCaller caller_;  // last: its thread ends before anything else goes

  QWidget* makeContent();
  CommandBox* makeCommands();
  SteppingBox* makeStepping();
  operating::Moment moment() const;
  std::string fullName(const std::string& service) const;
  void callService(const std::string& service, const std::function<bool(const std::string&)>& call);
  void takeAnswer(const ServiceCaller::Answer& answer);
  void displayStatus(double now);
};

/// ProcedureWidget as a panel of rviz, below a button for what the main view shows. Keeps the namespace in rviz's
/// configuration.
class ProcedurePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ProcedurePanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  void lookThroughEndoscope(bool on);

  QPushButton* endoscope_;
  ProcedureWidget* widget_;
};

}  // namespace vibe::rviz_plugins
