// web_node: the session in any browser, and in any headset that a browser knows.

#include <cstdio>
#include <exception>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "operator_drive.hpp"
#include "session_stream.hpp"
#include "vibe_ros_utils/startup.hpp"
#include "web_options.hpp"

namespace web = vibe::web;

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]
constexpr double kTick = 0.01;          // [s]

const char* const kHelp =
    "Usage: rosrun vibe_web web_node [--lan] [_port:=8890] [_lan:=true] [_behind:=URL] [_page:=FOLDER]\n"
    "       [_certificates:=FOLDER]\n"
    "Shows the session of a simulator, or of vibe_player, to browsers of this machine; with --lan to those of its\n"
    "network, with a token and TLS. docs/web.md has more.\n";

int fail(const std::exception& error, int status) {
  std::fprintf(stderr, "web_node: %s\n", error.what());
  return status;
}

void invite(const web::NodeOptions& options, const web::Opening& opening, std::uint16_t port) {
  const std::vector<std::string> addresses = web::pageAddresses(options, opening, port);
  std::printf("%s\n", web::invitation(opening.certificates, addresses).c_str());
  std::fflush(stdout);
  if (!opening.server.token.empty()) web::printQrCode(addresses.front());
}

void run(const web::NodeOptions& options, const web::Opening& opening) {
  ros::NodeHandle handle;
  web::OperatorDrive drive(handle);
  web::WebServer server(
      opening.server, [&](web::ClientId client, const web::Command& command) { drive.receive(client, command); },
      [&](web::ClientId client) { drive.leave(client); });
  web::SessionStream stream(handle, server);
  const std::string& root = opening.certificates.root;
  if (!root.empty())
    server.provide("/root.crt", {"application/x-x509-ca-cert", std::make_shared<const std::string>(root), false});
  invite(options, opening, server.port());
  int ticks = 0;
  const ros::WallTimer timer = handle.createWallTimer(ros::WallDuration(kTick), [&](const ros::WallTimerEvent&) {
    drive.tick(server, stream.showsRecording());
    if (++ticks % 10 == 0) stream.tick();
  });
  while (ros::ok() && vibe::ros_utils::stopSignal() == 0)
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  drive.goodbye();
}

}  // namespace

int main(int argc, char** argv) {
  if (vibe::ros_utils::asksForHelp(argc, argv)) return std::fputs(kHelp, stdout), 0;
  web::NodeOptions options;
  web::Opening opening;
  try {
    vibe::ros_utils::initWithGoodbye(argc, argv, "web_node");
    if (!vibe::ros_utils::waitForMaster(kMasterPatience)) return 0;
    options = web::readOptions(ros::NodeHandle("~"), argc, argv);
    opening = web::openingOf(options);
  } catch (const std::exception& error) {
    return fail(error, kUsage);
  }
  try {
    run(options, opening);
  } catch (const std::exception& error) {
    return fail(error, kFailure);
  }
  return 0;
}
