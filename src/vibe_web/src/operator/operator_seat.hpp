#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include "protocol/command.hpp"

namespace vibe::web {

using ClientId = std::uint64_t;  ///< of a connection; 0: nobody

constexpr double kDeadMan = 0.3;  ///< a page that drives and is silent for longer lets go of everything [s]
constexpr double kLapse = 5;      ///< one that was silent for longer wants new presses: its link or its tab slept [s]
constexpr double kAbsent = 10;    ///< one that is silent for longer gives its place to others [s]

/// The place of the one page that may drive. Times are of a steady clock [s].
class OperatorSeat {
 public:
  /// @param is_button  of a key: it presses a button of the device, and does not move a joint
  explicit OperatorSeat(std::function<bool(int)> is_button) : is_button_(std::move(is_button)) {}

  /// @param grant  what the drive messages of this client have to name; not used before
  /// @return whether the seat was free, or is theirs already
  bool take(ClientId client, std::uint32_t grant, double now);
  /// Of a client that gives back control, or is gone. @return whether it had the seat
  bool leave(ClientId client);

  /// @return whether the message counts: it comes from the one in the seat, names its grant and is newer than all
  /// before. Then it is what is held from now on; but of a button that the silence has let go a new press is wanted,
  /// because pressed again it would do the opposite, and after a lapse of everything.
  bool receive(ClientId client, const Command& drive, double now);

  /// Lets go of everything if the page is silent, and empties the seat if it is silent for long.
  void tick(double now);

  ClientId holder() const { return holder_; }
  std::uint32_t grant() const { return grant_; }
  const std::set<int>& keys() const { return keys_; }
  const std::array<double, kAxes>& axes() const { return axes_; }

 private:
  std::function<bool(int)> is_button_;
  ClientId holder_ = 0;
  std::uint32_t grant_ = 0, number_ = 0;
  double last_received_ = 0;
  bool slept_ = false;  // and what it holds has not come up since
  std::set<int> keys_;
  std::set<int> stale_;  // buttons that the silence has let go, and that have not come up since
  std::array<double, kAxes> axes_{};

  void letGo();
};

}  // namespace vibe::web
