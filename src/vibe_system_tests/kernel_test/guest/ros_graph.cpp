#include "ros_graph.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <ros/callback_queue.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "statistics.hpp"

namespace vibe::hardware {

ChildProcess::ChildProcess(const std::vector<std::string>& command) : pid_(fork()) {
  if (pid_ < 0) throw std::runtime_error("cannot start " + command.at(0));
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  std::perror(arguments[0]);
  _exit(127);
}

ChildProcess::~ChildProcess() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

bool ChildProcess::running() const {
  return ending() == "runs";
}

std::string ChildProcess::ending() const {
  siginfo_t state{};
  const int failed = waitid(P_PID, static_cast<id_t>(pid_), &state, WEXITED | WNOHANG | WNOWAIT);
  if (failed == 0 && state.si_pid == 0) return "runs";
  return (state.si_code == CLD_EXITED ? "exit status " : "signal ") + std::to_string(state.si_status);
}

namespace {

constexpr double kMasterTimeout = 120;  // [s]; Python starts slowly in an emulated processor

}  // namespace

RosGraph::Connection::Connection() {
  if (ros::isInitialized()) return;
  ros::init(ros::M_string{}, "hid_guest", ros::init_options::NoSigintHandler);
  const double end = now() + kMasterTimeout;
  while (!ros::master::check()) {
    if (now() > end) throw std::runtime_error("rosmaster does not answer; see rosmaster.log");
    ros::WallDuration(0.1).sleep();
  }
}

RosGraph::RosGraph() = default;

std::unique_ptr<ChildProcess> RosGraph::start(const std::string& node, const std::vector<std::string>& parameters) {
  const char* devel = std::getenv("VIBE_DEVEL");
  if (!devel) throw std::runtime_error("VIBE_DEVEL is not set; run scripts/hid_kernel");
  std::vector<std::string> command{std::string(devel) + "/lib/vibe_hardware/" + node};
  command.insert(command.end(), parameters.begin(), parameters.end());
  return std::make_unique<ChildProcess>(command);
}

bool RosGraph::waitUntil(const std::function<bool()>& condition, double timeout) {
  const double end = now() + timeout;
  while (!condition()) {
    if (now() > end) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

}  // namespace vibe::hardware
