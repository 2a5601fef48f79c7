#pragma once

#include <string>

#include <ros/node_handle.h>

#include "server/web_server.hpp"

namespace vibe::web {

struct NodeOptions {
  bool lan = false;          ///< for other machines, with token and TLS
  int port = 8890;           ///< 0: one that is free
  std::string page;          ///< folder of the built page
  std::string certificates;  ///< folder for certificate and key
};

/// Private parameters lan, port, page and certificates, and --lan on the command line.
/// @throws vibe::Error  for a value that cannot be, or an option that there is not
NodeOptions readOptions(const ros::NodeHandle& handle, int argc, const char* const* argv);

/// Makes token and certificate where others may look.
/// @throws std::runtime_error  see provideCertificate()
ServerOptions serverOptions(const NodeOptions& options);

/// What to type into a browser, one line per address; with a token it is after #, which browsers send to nobody.
std::string invitation(const ServerOptions& options, std::uint16_t port);

}  // namespace vibe::web
