#include "server/host_names.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <unistd.h>

namespace vibe::web {

namespace {

/// Empty for what is no address of a network.
std::string networkAddress(const ifaddrs& entry) {
  if (entry.ifa_addr == nullptr || (entry.ifa_flags & IFF_LOOPBACK) != 0) return "";
  const int family = entry.ifa_addr->sa_family;
  const void* address = nullptr;
  if (family == AF_INET) address = &reinterpret_cast<const sockaddr_in*>(entry.ifa_addr)->sin_addr;
  if (family == AF_INET6) {
    const in6_addr& found = reinterpret_cast<const sockaddr_in6*>(entry.ifa_addr)->sin6_addr;
    if (!IN6_IS_ADDR_LINKLOCAL(&found)) address = &found;  // that of one link needs its name, which no URL has
  }
  std::array<char, INET6_ADDRSTRLEN> text;
  if (address == nullptr || ::inet_ntop(family, address, text.data(), text.size()) == nullptr) return "";
  return text.data();
}

}  // namespace

std::vector<std::string> networkAddresses() {
  std::vector<std::string> addresses;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return addresses;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owned(all, ::freeifaddrs);
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const std::string address = networkAddress(*each);
    if (!address.empty()) addresses.push_back(address);
  }
  std::stable_partition(addresses.begin(), addresses.end(),
                        [](const std::string& address) { return address.find(':') == std::string::npos; });
  return addresses;
}

std::vector<std::string> hostNames() {
  std::array<char, 256> text{};
  ::gethostname(text.data(), text.size() - 1);
  const std::string name = text.data();
  return {name, name.substr(0, name.find('.')) + ".local"};
}

}  // namespace vibe::web
