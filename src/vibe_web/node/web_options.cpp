#include "web_options.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "server/host_names.hpp"
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
  parameters.read("behind", options.behind);
  parameters.read("port", options.port, 0, 65535);
  parameters.read("page", options.page);
  parameters.read("certificates", options.certificates);
  parameters.finish();
  if (!options.behind.empty()) originOf(options.behind);
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word != "--lan") throw Error("There is no option '" + word + "'; the only one is --lan.");
    options.lan = true;
  }
  return options;
}

std::string originOf(const std::string& address) {
  static const std::regex form("(https?://[^/?#@\\s]+?)(:\\d+)?(/[^?#\\s]*)?", std::regex::icase);
  std::smatch part;
  if (!std::regex_match(address, part, form))
    throw Error("The parameter behind is '" + address + "', which is no address such as https://lab.example/vibe/.");
  std::string origin = part[1];
  std::transform(origin.begin(), origin.end(), origin.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string port = part[2];
  return port == (origin[4] == 's' ? ":443" : ":80") ? origin : origin + port;
}

Opening openingOf(const NodeOptions& options) {
  Opening opening;
  ServerOptions& server = opening.server;
  server.port = static_cast<std::uint16_t>(options.port);
  server.page = options.page;
  if (!options.behind.empty()) server.origin = originOf(options.behind);
  if (options.lan || !options.behind.empty()) server.token = makeToken();
  if (!options.lan) return opening;
  server.addresses = {"0.0.0.0", "::"};
  std::vector<std::string> names = networkAddresses();
  const std::vector<std::string> hosts = hostNames();
  names.insert(names.end(), hosts.begin(), hosts.end());
  names.insert(names.end(), {"localhost", "127.0.0.1", "::1"});
  opening.certificates = provideCertificates(options.certificates, names);
  server.certificate = opening.certificates.certificate;
  server.key = opening.certificates.key;
  return opening;
}

std::vector<std::string> pageAddresses(const NodeOptions& options, const Opening& opening, std::uint16_t port) {
  const std::string hash = opening.server.token.empty() ? "" : "#token=" + opening.server.token;
  std::vector<std::string> addresses, hosts;
  if (!options.behind.empty()) addresses.push_back(options.behind + (options.behind.back() == '/' ? "" : "/") + hash);
  if (options.lan) hosts = networkAddresses();
  if (hosts.empty() && addresses.empty()) hosts.emplace_back("localhost");
  for (const std::string& host : hosts) {
    const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
    addresses.push_back((options.lan ? "https://" : "http://") + name + ":" + std::to_string(port) + "/" + hash);
  }
  return addresses;
}

std::string invitation(const Certificates& certificates, const std::vector<std::string>& addresses) {
  if (certificates.leaf.empty()) return "Open " + addresses.front() + " in a browser.";
  std::string text = "Open one of these addresses in a browser:";
  for (const std::string& address : addresses) text += "\n  " + address;
  text += "\nThe browser warns of the certificate, whose SHA-256 is\n  " + fingerprint(certificates.leaf);
  if (certificates.root.empty()) return text;
  const std::string& page = addresses.front();
  return text + "\nIt does not once " + page.substr(0, page.find('#')) + "root.crt is installed, whose SHA-256 is\n  " +
         fingerprint(certificates.root);
}

void printQrCode(const std::string& address) {
  // not as an argument, which every user of the machine sees
  std::FILE* program = ::popen(
      "if command -v qrencode >/dev/null; then qrencode -t ANSIUTF8; else cat >/dev/null; "
      "echo 'The address would be here as a QR code, too: apt install qrencode'; fi",
      "w");
  if (program == nullptr) return;
  std::fputs(address.c_str(), program);
  ::pclose(program);
}

}  // namespace vibe::web
