#include "vibe_graphics/graphics/virtual_display.hpp"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace vibe::graphics {
namespace {

constexpr int kStartTimeout = 30;  // for Xvfb to be ready, on a busy machine [s]

const char* const kRemedy =
    "There is no display, and Xvfb, which would replace it, does not start; install it with apt-get install "
    "xvfb.";

bool displayAnswers() {
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr) return false;
  XCloseDisplay(display);
  return true;
}

/// What becomes Xvfb: nothing but system calls between fork and exec.
[[noreturn]] void becomeXvfb(int number_pipe, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // it was gone before that took effect
  setsid();                           // the terminal's Ctrl-C is for the node, which still needs its display
  dup2(number_pipe, 3);
  const int nowhere = open("/dev/null", O_RDWR);  // it tells of every display number that is taken
  for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
  execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "64x64x24", "-nolisten", "tcp", "-noreset",
         static_cast<char*>(nullptr));
  _exit(127);
}

/// The number of the display that Xvfb writes once it is ready; empty: it has ended, or is not ready in time.
std::string readNumber(int pipe) {
  std::string number;
  char letter = 0;
  pollfd ready{pipe, POLLIN, 0};
  while (poll(&ready, 1, 1000 * kStartTimeout) == 1 && read(pipe, &letter, 1) == 1) {
    if (letter == '\n') return number;
    number += letter;
  }
  return "";
}

}  // namespace

void provideDisplay() {
  if (displayAnswers()) return;
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(kRemedy);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) becomeXvfb(ends[1], parent);
  close(ends[1]);
  const std::string number = child > 0 ? readNumber(ends[0]) : "";
  close(ends[0]);
  if (number.empty()) {
    if (child > 0) kill(child, SIGTERM);
    throw std::runtime_error(kRemedy);
  }
  setenv("DISPLAY", (":" + number).c_str(), 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  if (!displayAnswers()) throw std::runtime_error(kRemedy);
}

}  // namespace vibe::graphics
