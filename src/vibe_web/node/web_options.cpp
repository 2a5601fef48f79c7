#include "web_options.hpp"

#include <cstdlib>
#include <filesystem>

#include "server/certificate.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::web {

namespace {

/// Beside the program: devel/lib/vibe_web/web_node and devel/share/vibe_web/page, and the same where it is installed.
std::string builtPage() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path().parent_path().parent_path() / "share/vibe_web/page").string();
}

std::string homeOfRos() {
  if (const char* home = std::getenv("ROS_HOME")) return home;
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : ".") + "/.ros";
}

}  // namespace

NodeOptions readOptions(const ros::NodeHandle& handle, int argc, const char* const* argv) {
  NodeOptions options;
  options.page = builtPage();
  options.certificates = homeOfRos() + "/vibe_web";
  ros_utils::ParameterReader parameters(handle);
  parameters.read("lan", options.lan);
  parameters.read("port", options.port, 0, 65535);
  parameters.read("page", options.page);
  parameters.read("certificates", options.certificates);
  parameters.finish();
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word != "--lan") throw Error("There is no option '" + word + "'; the only one is --lan.");
    options.lan = true;
  }
  return options;
}

ServerOptions serverOptions(const NodeOptions& options) {
  ServerOptions server;
  server.port = static_cast<std::uint16_t>(options.port);
  server.page = options.page;
  if (!options.lan) return server;
  server.address = "0.0.0.0";
  server.token = makeToken();
  std::vector<std::string> names = networkAddresses();
  names.insert(names.end(), {"localhost", "127.0.0.1"});
  const CertificateFiles files = provideCertificate(options.certificates, names);
  server.certificate = files.certificate;
  server.key = files.key;
  return server;
}

std::string invitation(const ServerOptions& options, std::uint16_t port) {
  const std::string end = ":" + std::to_string(port) + "/";
  if (options.token.empty()) return "Open http://localhost" + end + " in a browser of this machine.";
  std::string text = "Open one of these addresses; browsers warn of the certificate, whose SHA-256 is\n  " +
                     fingerprint(options.certificate);
  std::vector<std::string> names = networkAddresses();
  if (names.empty()) names.emplace_back("localhost");
  for (const std::string& name : names) text += "\n  https://" + name + end + "#token=" + options.token;
  return text;
}

}  // namespace vibe::web
