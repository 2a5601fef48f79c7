#pragma once
#include <stdexcept>
#include <string>

namespace vibe {

/// The exception type of every loader and builder of this library. The message is one sentence that names the error,
/// its place (file, line, key, vertex ...) and the remedy. Programs print what() and exit with status 2.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vibe
