#include "operator/operator_seat.hpp"

#include <algorithm>
#include <iterator>

namespace vibe::web {

bool OperatorSeat::take(ClientId client, std::uint32_t grant, double now) {
  if (holder_ != 0 && holder_ != client) return false;
  if (holder_ == client) return true;
  letGo();
  holder_ = client;
  grant_ = grant;
  number_ = 0;
  slept_ = false;
  stale_.clear();
  last_received_ = now;
  return true;
}

bool OperatorSeat::leave(ClientId client) {
  if (holder_ == 0 || client != holder_) return false;
  letGo();
  holder_ = 0;
  return true;
}

bool OperatorSeat::receive(ClientId client, const Command& drive, double now) {
  if (holder_ == 0 || client != holder_ || drive.grant != grant_ || drive.number <= number_) return false;
  number_ = drive.number;
  const bool empty = drive.keys.empty() && drive.axes == decltype(axes_){};
  slept_ = (slept_ || now - last_received_ > kLapse) && !empty;
  last_received_ = now;
  const std::set<int> held(drive.keys.begin(), drive.keys.end()), stale = std::exchange(stale_, {});
  letGo();
  std::set_intersection(stale.begin(), stale.end(), held.begin(), held.end(), std::inserter(stale_, stale_.end()));
  if (slept_) return true;
  std::set_difference(held.begin(), held.end(), stale_.begin(), stale_.end(), std::inserter(keys_, keys_.end()));
  axes_ = drive.axes;
  return true;
}

void OperatorSeat::tick(double now) {
  if (holder_ == 0) return;
  if (now - last_received_ > kDeadMan) {
    std::copy_if(keys_.begin(), keys_.end(), std::inserter(stale_, stale_.end()), is_button_);
    letGo();
  }
  if (now - last_received_ > kAbsent) holder_ = 0;
}

void OperatorSeat::letGo() {
  keys_.clear();
  axes_.fill(0);
}

}  // namespace vibe::web
