#pragma once

#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "server/certificate.hpp"
#include "server/web_server.hpp"

namespace vibe::web {

struct NodeOptions {
  bool lan = false;          ///< for other machines, with token and TLS
  std::string behind;        ///< where a reverse proxy shows the page; empty: there is none
  int port = 8890;           ///< 0: one that is free
  std::string page;          ///< folder of the built page
  std::string certificates;  ///< folder for certificate and key
};

/// Private parameters lan, behind, port, page and certificates, and --lan on the command line.
/// @throws vibe::Error  for a value that cannot be, or an option that there is not
NodeOptions readOptions(const ros::NodeHandle& handle, int argc, const char* const* argv);

/// Of an address, as browsers send it: scheme, host and port, unless it is that of the scheme.
/// @throws vibe::Error  it is no address of a page
std::string originOf(const std::string& address);

/// How a server begins: who may look, and what others are told.
struct Opening {
  ServerOptions server;
  Certificates certificates;  ///< empty without TLS
};

/// Makes token and certificates where others may look.
/// @throws std::runtime_error  see provideCertificates()
Opening openingOf(const NodeOptions& options);

/// Where browsers find the page; a token is after #, which they send to nobody.
std::vector<std::string> pageAddresses(const NodeOptions& options, const Opening& opening, std::uint16_t port);

/// What a person is told of them.
std::string invitation(const Certificates& certificates, const std::vector<std::string>& addresses);

/// On the terminal, for cameras.
void printQrCode(const std::string& address);

}  // namespace vibe::web
