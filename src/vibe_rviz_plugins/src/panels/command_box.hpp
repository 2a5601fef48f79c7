#pragma once
#include <QWidget>
#include <array>
#include <functional>

#include "messages/button_bank.hpp"

class QLabel;
class QPushButton;

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

  /// @param down      buttons pressed by the publisher in control
  /// @param sentence  who is in control
  void display(bool in_control, const std::array<std::int32_t, kCommandCount>& down, const std::string& sentence);

 private:
  Actions actions_;
  QPushButton* control_;
  QLabel* sentence_;
  std::array<QPushButton*, kCommandCount> buttons_{};
  std::array<std::int32_t, kCommandCount> shown_{};
  bool shown_control_ = false;

  void makeButton(int button);
};

}  // namespace vibe::rviz_plugins
