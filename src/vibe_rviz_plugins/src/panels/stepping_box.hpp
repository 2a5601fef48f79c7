#pragma once
#include <QWidget>
#include <functional>
#include <string>

class QLabel;
class QPushButton;
class QSpinBox;

namespace vibe::rviz_plugins {

/// Pause, single steps and reset, and the answer of the simulator.
class SteppingBox : public QWidget {
 public:
  /// Actions of the buttons; the owner sets all of them, and they must return immediately.
  struct Actions {
    std::function<void(bool paused)> pause;
    std::function<void(unsigned n)> step;
    std::function<void()> reset;
    std::function<void()> stop_waiting;
  };

  explicit SteppingBox(Actions actions, QWidget* parent = nullptr);

  /// @param known  whether a state has been received
  void displayState(bool known, bool paused);
  /// A call has been in progress for this time [s].
  void displayWaiting(const std::string& service, double seconds);
  /// No call is in progress.
  void displayAnswer(bool success, const std::string& sentence);

 private:
  Actions actions_;
  QPushButton *pause_, *step_, *reset_, *stop_waiting_;
  QSpinBox* count_;
  QLabel* answer_;
  bool paused_ = false, waiting_ = false, asked_ = false;

  void connectAll();
  void enableAll();
  void pressReset();
};

}  // namespace vibe::rviz_plugins
