#include "server/access.hpp"

#include <array>
#include <cstdio>
#include <stdexcept>

#include <openssl/crypto.h>
#include <openssl/rand.h>

namespace vibe::web {

namespace {

/// Without the port; brackets of an IPv6 address stay.
std::string nameOf(const std::string& host) {
  const std::size_t colon = host.rfind(':');
  const std::size_t bracket = host.rfind(']');
  if (colon == std::string::npos || (bracket != std::string::npos && colon < bracket)) return host;
  return host.substr(0, colon);
}

bool isLoopback(const std::string& host) {
  const std::string name = nameOf(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

/// In the same time wherever they differ.
bool isSame(const std::string& given, const std::string& wanted) {
  return given.size() == wanted.size() && CRYPTO_memcmp(given.data(), wanted.data(), wanted.size()) == 0;
}

}  // namespace

std::string hostRefusal(const AccessRule& rule, const Caller& caller) {
  if (!rule.token.empty() || isLoopback(caller.host)) return "";
  return "The host is called neither localhost nor 127.0.0.1; start the server with --lan to show it to others.";
}

std::string streamRefusal(const AccessRule& rule, const Caller& caller) {
  const std::string host = hostRefusal(rule, caller);
  if (!host.empty()) return host;
  const std::string own = (rule.secure ? "https://" : "http://") + caller.host;
  if (!caller.origin.empty() && caller.origin != own && (rule.origin.empty() || caller.origin != rule.origin))
    return "The page comes from another server; open the address that the terminal of the server shows.";
  if (rule.token.empty() || isSame(queryValue(caller.target, "token"), rule.token)) return "";
  return "The token is missing or wrong; open the address that the terminal of the server shows.";
}

std::string queryValue(const std::string& target, const std::string& name) {
  std::size_t begin = target.find('?');
  while (begin != std::string::npos) {
    const std::size_t end = target.find('&', begin + 1);
    const std::string pair = target.substr(begin + 1, end == std::string::npos ? end : end - begin - 1);
    if (pair.compare(0, name.size() + 1, name + "=") == 0) return pair.substr(name.size() + 1);
    begin = end;
  }
  return "";
}

std::string makeToken() {
  std::array<unsigned char, 16> bytes;
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("The system gives no random numbers for a token.");
  std::string token;
  for (const unsigned char byte : bytes) {
    std::array<char, 3> digits;
    std::snprintf(digits.data(), digits.size(), "%02x", byte);
    token += digits.data();
  }
  return token;
}

}  // namespace vibe::web
