#include "operator/operator_seat.hpp"

namespace vibe::web {

bool OperatorSeat::take(ClientId client, std::uint32_t grant, double now) {
  if (holder_ != 0 && holder_ != client) return false;
  if (holder_ == client) return true;
  letGo();
  holder_ = client;
  grant_ = grant;
  number_ = 0;
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
  last_received_ = now;
  keys_ = {drive.keys.begin(), drive.keys.end()};
  axes_ = drive.axes;
  return true;
}

void OperatorSeat::tick(double now) {
  if (holder_ == 0) return;
  if (now - last_received_ > kDeadMan) letGo();
  if (now - last_received_ > kAbsent) holder_ = 0;
}

void OperatorSeat::letGo() {
  keys_.clear();
  axes_.fill(0);
}

}  // namespace vibe::web
