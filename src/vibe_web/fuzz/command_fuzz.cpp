// sources: src/protocol/command.cpp src/operator/operator_seat.cpp
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "operator/operator_seat.hpp"
#include "protocol/command.hpp"

// Any bytes as a command of a page: nothing, or a command within its limits; and rows of them in the operator's seat,
// in which nobody but the one who was granted it holds anything.

namespace web = vibe::web;

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const web::Command& command) {
  require(command.keys.size() <= web::kMaxKeys);
  for (const double axis : command.axes) require(axis >= -1 && axis <= 1);
  require(command.speed > 0 && command.speed <= 100);
  require(command.time >= 0 && std::isfinite(command.time));
  for (const auto& pose : command.viewer.poses)
    for (std::size_t k = 0; pose && k < pose->size(); ++k) require(std::abs((*pose)[k]) <= web::kFarthest);
  for (const double stick : command.viewer.sticks) require(stick >= -1 && stick <= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::uint8_t> bytes(data, data + size);  // a copy, so that the sanitizer sees its end
  if (const auto command = web::decodeCommand(bytes.data(), bytes.size())) check(*command);

  constexpr std::uint32_t kGrant = 0x12345678;
  web::OperatorSeat seat([](int key) { return key % 2 == 0; });
  double now = 0;
  for (std::size_t at = 0; at + 1 < size;) {
    const std::size_t length = bytes[at] % (web::kMaxCommand + 1), end = std::min(size, at + 1 + length);
    const auto command = web::decodeCommand(bytes.data() + at + 1, end - at - 1);
    const web::ClientId client = 1 + bytes[at] % 3;
    if (command && command->kind == web::Command::Kind::Take) seat.take(client, kGrant, now);
    if (command && command->kind == web::Command::Kind::GiveBack) seat.leave(client);
    if (command && command->kind == web::Command::Kind::Drive && seat.receive(client, *command, now))
      require(client == seat.holder() && command->grant == kGrant);
    now += 0.1;
    seat.tick(now);
    require(seat.holder() != 0 || seat.keys().empty());
    at = end;
  }
  return 0;
}
