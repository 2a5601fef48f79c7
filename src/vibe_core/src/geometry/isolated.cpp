#include "geometry/isolated.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr char kResult = 'r';
constexpr char kFailure = 'f';

/// Nothing of the child may be seen or inherited: no message of a failed assertion, no core file, no handler.
void confine(const WorkLimits& limits) {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
#ifndef __SANITIZE_ADDRESS__
  const rlimit memory{limits.memory, limits.memory};
  setrlimit(RLIMIT_AS, &memory);
#endif
  for (const int number : {SIGALRM, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGTERM, SIGPIPE}) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  alarm(limits.seconds);
}

void writeAll(int pipe, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(pipe, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) return;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void runChild(int pipe, const std::function<std::string()>& work, const WorkLimits& limits) {
  confine(limits);
  try {
    writeAll(pipe, kResult + work());
  } catch (const std::exception& e) {
    writeAll(pipe, kFailure + std::string(e.what()));
  }
  _exit(0);  // without the destructors of the parent's objects
}

std::string readAll(int pipe) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  for (;;) {
    const ssize_t count = read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(count));
  }
}

int waitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

std::string runIsolated(const std::function<std::string()>& work, const WorkLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(std::string("no pipe can be made: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    runChild(ends[1], work, limits);
  }
  close(ends[1]);
  const std::string answer = child > 0 ? readAll(ends[0]) : std::string();
  close(ends[0]);
  if (child < 0) throw Error(std::string("no process can be started: ") + std::strerror(errno));
  const int status = waitFor(child);
  if (WIFEXITED(status) && !answer.empty() && answer[0] == kResult) return answer.substr(1);
  if (WIFEXITED(status) && answer.size() > 1) throw Error(answer.substr(1));
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
    throw Error("it takes more than " + std::to_string(limits.seconds) + " s");
  }
  throw Error("its content stops the reader");
}

}  // namespace vibe
