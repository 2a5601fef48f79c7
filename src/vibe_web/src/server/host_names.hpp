#pragma once

#include <string>
#include <vector>

namespace vibe::web {

/// Numeric addresses of this machine in networks, those of IPv4 first; without loopback and those of one link.
std::vector<std::string> networkAddresses();

/// The name of this machine, and the one that it has by mDNS.
std::vector<std::string> hostNames();

}  // namespace vibe::web
