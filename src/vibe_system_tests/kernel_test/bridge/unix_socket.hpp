#pragma once
#include <string>

namespace vibe::hardware {

/// Makes a unix stream socket that listens at this path, without blocking. @return its descriptor  @throws
/// std::runtime_error
int listenAt(const std::string& path);

/// Connects to a unix stream socket, waiting until somebody listens there.
/// @param timeout  [s]
/// @return the descriptor  @throws std::runtime_error: nobody listened in time
int connectTo(const std::string& path, double timeout);

/// Accepts a connection and makes it non-blocking. @return its descriptor; -1: nobody has connected
/// @throws std::runtime_error
int acceptFrom(int listener);

}  // namespace vibe::hardware
