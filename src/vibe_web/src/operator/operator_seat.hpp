#pragma once

#include <cstdint>
#include <set>

#include "protocol/command.hpp"

namespace vibe::web {

using ClientId = std::uint64_t;  ///< of a connection; 0: nobody

constexpr double kDeadMan = 0.3;  ///< a page that drives and is silent for longer lets go of everything [s]
constexpr double kAbsent = 10;    ///< one that is silent for longer gives its place to others [s]

/// The place of the one page that may drive. Times are of a steady clock [s].
class OperatorSeat {
 public:
  /// @param grant  what the drive messages of this client have to name; not used before
  /// @return whether the seat was free, or is theirs already
  bool take(ClientId client, std::uint32_t grant, double now);
  /// Of a client that gives back control, or is gone. @return whether it had the seat
  bool leave(ClientId client);

  /// @return whether the message counts: it comes from the one in the seat, names its grant and is newer than all
  /// before. Then it is what is held from now on.
  bool receive(ClientId client, const Command& drive, double now);

  /// Lets go of everything if the page is silent, and empties the seat if it is silent for long.
  void tick(double now);

  ClientId holder() const { return holder_; }
  std::uint32_t grant() const { return grant_; }
  const std::set<int>& keys() const { return keys_; }
  const std::array<double, kAxes>& axes() const { return axes_; }

 private:
  ClientId holder_ = 0;
  std::uint32_t grant_ = 0, number_ = 0;
  double last_received_ = 0;
  std::set<int> keys_;
  std::array<double, kAxes> axes_{};

  void letGo();
};

}  // namespace vibe::web
