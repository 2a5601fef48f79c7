#include "operator_drive.hpp"

#include <chrono>
#include <limits>
#include <random>
#include <utility>

#include <vibe_msgs/ReplayCommand.h>
#include <nlohmann/json.hpp>

#include "protocol/byte_writer.hpp"
#include "state_text.hpp"

namespace vibe::web {

using nlohmann::json;

namespace {

constexpr double kButtonPeriod = 0.1;  // [s]
constexpr double kLongestStep = 0.1;   // [s]

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool isButton(int key) {
  const operating::KeyBinding* binding = operating::findBinding(key);
  return binding != nullptr && binding->kind == operating::KeyBinding::Kind::Button;
}

}  // namespace

OperatorDrive::OperatorDrive(ros::NodeHandle& handle)
    : seat_(isButton),
      drive_("web_node"),
      replay_(handle.advertise<vibe_msgs::ReplayCommand>("replay/command", 10)),
      viewer_(handle),
      last_(steadyNow()) {}

void OperatorDrive::receive(ClientId client, const Command& command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  received_.emplace_back(client, command);
}

void OperatorDrive::leave(ClientId client) {
  const std::lock_guard<std::mutex> lock(mutex_);
  left_.push_back(client);
}

void OperatorDrive::tick(WebServer& server, bool recording) {
  std::vector<std::pair<ClientId, Command>> received;
  std::vector<ClientId> left;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    received.swap(received_);
    left.swap(left_);
  }
  for (const auto& [client, command] : received) obey(client, command, server);
  for (const ClientId client : left) seat_.leave(client);
  const double now = steadyNow();
  seat_.tick(now);
  viewer_.tick(now, server);
  passKeys();
  moveAxes(std::min(now - last_, kLongestStep));
  last_ = now;
  if (now - ticked_ < kButtonPeriod) return;
  ticked_ = now;
  const bool drives = seat_.holder() != 0 && !recording;
  if (drives != std::exchange(started_, drives)) drives ? drive_.start("") : drive_.stop();
  drive_.tick();
  publish(server);
}

void OperatorDrive::obey(ClientId client, const Command& command, WebServer& server) {
  switch (command.kind) {
    case Command::Kind::Take:
      return takeSeat(client, server);
    case Command::Kind::GiveBack:
      seat_.leave(client);
      return;
    case Command::Kind::Drive:
      if (seat_.receive(client, command, steadyNow())) return passKeys();
      server.send(
          client, Kind::Refusal,
          textMessage(Kind::Refusal, "A drive message does not count: it is old, or this page does not drive."));
      return;
    case Command::Kind::Replay:
      if (client == seat_.holder()) replay(command);
      return;
    case Command::Kind::Viewer:
      if (client == seat_.holder()) viewer_.receive(command.viewer);
      return;
    case Command::Kind::Rate:
    case Command::Kind::Ping:
    case Command::Kind::Drawn:
      return;  // the server's own
  }
}

void OperatorDrive::takeSeat(ClientId client, WebServer& server) {
  const bool had = seat_.holder() == client;
  std::random_device random;
  if (!seat_.take(client, random(), steadyNow())) {
    server.send(client, Kind::Refusal,
                textMessage(Kind::Refusal, "Another page drives; it has to give control back, or to be closed."));
    return;
  }
  if (!had) ++seats_;
  server.send(client, Kind::Grant, textMessage(Kind::Grant, dumped({{"seat", seats_}, {"grant", seat_.grant()}})));
}

void OperatorDrive::replay(const Command& command) {
  vibe_msgs::ReplayCommand message;
  message.play = command.play;
  message.rate = command.speed;
  message.seek = command.seek ? command.time : std::numeric_limits<double>::quiet_NaN();
  message.exact = true;
  replay_.publish(message);
}

/// With every message of the page: a key may go down and come up between two ticks.
void OperatorDrive::passKeys() {
  const std::set<int>& wanted = seat_.keys();
  for (const int key : std::set<int>(down_))
    if (wanted.count(key) == 0) drive_.keyUp(key), down_.erase(key);
  for (const int key : wanted)
    if (down_.insert(key).second) drive_.keyDown(key);
}

void OperatorDrive::moveAxes(double seconds) {
  const operating::DriveSpeeds speeds;
  for (std::size_t joint = 0; joint < kAxes; ++joint)
    if (seat_.axes()[joint] != 0)
      drive_.displace(static_cast<int>(joint), seat_.axes()[joint] * speeds.keys[joint] * seconds);
}

void OperatorDrive::publish(WebServer& server) {
  const operating::DriveView view = drive_.view();
  const std::string now = dumped({{"seat", seat_.holder() != 0 ? seats_ : 0},
                                  {"driving", view.driving},
                                  {"trouble", seat_.holder() != 0 ? view.trouble : ""},
                                  {"step", view.step.text},
                                  {"keys", view.keys_down},
                                  {"gear", static_cast<int>(view.gear)},
                                  {"buttons", view.buttons},
                                  {"joints", view.joints}});
  if (now == published_) return;
  published_ = now;
  server.publish(Kind::Operator, textMessage(Kind::Operator, now));
}

void OperatorDrive::goodbye() {
  if (!started_) return;
  drive_.stop();
  for (int k = 0; k < 10 && !drive_.isSilent(); ++k) {
    ros::WallDuration(kButtonPeriod).sleep();
    drive_.tick();
  }
}

}  // namespace vibe::web
