#pragma once

#include <QWidget>
#include <array>
#include <functional>
#include <string>

#include "vibe_operator/messages/button_bank.hpp"

class QLabel;
class QPushButton;
class QSpinBox;

namespace vibe::rviz_plugins {

/// The six buttons of the device and the switch that takes control of them.
class CommandBox : public QWidget {
 public:
  /// Actions of the buttons; the owner sets all of them.
  struct Actions {
    std::function<void(bool on)> control;
    std::function<void(int button)> press, release;
  };

  explicit CommandBox(Actions actions, QWidget* parent = nullptr);

  /// @param may_take  whether control could be taken now
  /// @param down      buttons pressed by the publisher in control
  /// @param sentence  who is in control
  void display(bool in_control, bool may_take, const std::array<std::int32_t, operating::kCommandCount>& down,
               const std::string& sentence);

 private:
  Actions actions_;
  QPushButton* control_;
  QLabel* sentence_;
  std::array<QPushButton*, operating::kCommandCount> buttons_{};
  std::array<std::int32_t, operating::kCommandCount> shown_{};
  bool shown_control_ = false;

  void makeButton(int button);
};

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
