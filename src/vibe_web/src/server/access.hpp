#pragma once

#include <string>

namespace vibe::web {

/// Who may open the stream.
struct AccessRule {
  std::string token;    ///< that the address has to contain; empty: pages of this machine only, without one
  bool secure = false;  ///< the server speaks TLS
  std::string origin;   ///< of pages that a reverse proxy serves; empty: there is none
};

/// What a request says about where it comes from.
struct Caller {
  std::string host;    ///< header Host
  std::string origin;  ///< header Origin; empty: not a page
  std::string target;  ///< path with query
};

/// Why a request is refused, as one sentence; empty: it is not. Without a token the name of the host must be that of
/// this machine's loopback, else a page of the network could reach it by a name that resolves to it (DNS rebinding).
std::string hostRefusal(const AccessRule& rule, const Caller& caller);

/// The same for the stream: also a page must come from this server, and the token must be right.
std::string streamRefusal(const AccessRule& rule, const Caller& caller);

/// Value of a query parameter, as it stands there; empty: there is none.
std::string queryValue(const std::string& target, const std::string& name);

/// A token that nobody can guess: 128 bits of the system's generator as 32 hexadecimal digits.
/// @throws std::runtime_error  the system has none
std::string makeToken();

}  // namespace vibe::web
