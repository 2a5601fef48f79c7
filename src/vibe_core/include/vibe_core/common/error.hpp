#pragma once
#include <stdexcept>
#include <string>

namespace vibe {

/// What every loader and builder of this library throws: one sentence that names the thing that is wrong, the
/// place (file, line, key, vertex ...) and the remedy. Programs print what() and exit with 2; nothing else is needed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vibe
