#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace vibe::hardware {

/// A program that runs as long as the object lives.
class ChildProcess {
 public:
  /// @param command  program and arguments  @throws std::runtime_error
  explicit ChildProcess(const std::vector<std::string>& command);
  ~ChildProcess();  ///< asks it to end and waits for that
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool running() const;

 private:
  pid_t pid_;
};

}  // namespace vibe::hardware
