#pragma once
#include <QWidget>
#include <functional>
#include <string>

class QLabel;
class QPushButton;
class QSpinBox;

namespace vibe {

/// Pause, single steps and reset, and what the simulator answered.
class SteppingBox : public QWidget {
 public:
  /// What happens when something is pressed; all are set by the owner and must return at once.
  struct Actions {
    std::function<void(bool paused)> pause;
    std::function<void(unsigned n)> step;
    std::function<void()> reset;
    std::function<void()> stop_waiting;
  };

  explicit SteppingBox(Actions actions, QWidget* parent = nullptr);

  /// @param known  whether a state has come at all
  void displayState(bool known, bool paused);
  /// A call is under way since so many seconds.
  void displayWaiting(const std::string& service, double seconds);
  /// None is.
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

}  // namespace vibe
