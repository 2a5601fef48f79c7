#include "vibe_ros_utils/startup.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include <malloc.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/time.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "vibe_core/program/error.hpp"

namespace vibe::ros_utils {
namespace {

volatile std::sig_atomic_t received_signal = 0;

void receiveSignal(int number) {
  received_signal = number;
}

// Limits of a user are raised in limits.conf(5).
std::string remedy(const char* limit) {
  return std::string("; add the line '@realtime - ") + limit +
         "' to /etc/security/limits.d/realtime.conf, the user to the group realtime, and log in again.";
}

/// @param thread  its id in Linux; 0: the calling one  @return errno
int setPriority(pid_t thread, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::sched_setscheduler(thread, SCHED_FIFO, &parameters) == 0 ? 0 : errno;
}

std::string refusal(int error, int priority) {
  return "The node runs without real-time priority: SCHED_FIFO " + std::to_string(priority) + " is not permitted (" +
         std::strerror(error) + ")" + remedy("rtprio 99");
}

}  // namespace

// roscpp makes this folder in ros::init() and fails with the words of a library.
std::string logFolderFault() {
  const char* home = std::getenv("HOME");
  if (std::getenv("ROS_LOG_DIR") != nullptr || std::getenv("ROS_HOME") != nullptr || home == nullptr) return "";
  const auto folder = std::filesystem::path(home) / ".ros" / "log";
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (!code) return "";
  return "The folder for logs, '" + folder.string() + "', cannot be made (" + code.message() +
         "); set ROS_HOME to a folder that you may write to, such as ROS_HOME=/tmp/ros_home.";
}

void init(int& argc, char** argv, const std::string& name, std::uint32_t options) {
  const std::string fault = logFolderFault();
  if (!fault.empty()) throw Error(fault);
  ros::init(argc, argv, name, options);
}

void initWithGoodbye(int& argc, char** argv, const std::string& name, std::uint32_t options) {
  init(argc, argv, name, options | ros::init_options::NoSigintHandler);
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, receiveSignal);
}

int stopSignal() {
  return received_signal;
}

void waitForStop() {
  while (ros::ok() && received_signal == 0) ros::WallDuration(0.02).sleep();
}

bool waitForMaster(double patience) {
  const ros::WallTime begin = ros::WallTime::now();
  bool announced = false;
  while (!ros::master::check()) {
    if (received_signal != 0) return false;
    if ((ros::WallTime::now() - begin).toSec() > patience)
      throw Error("No ROS master answers at " + ros::master::getURI() + "; start roscore, or set ROS_MASTER_URI.");
    if (!announced) std::fprintf(stderr, "Waiting for a ROS master at %s ...\n", ros::master::getURI().c_str());
    announced = true;
    ros::WallDuration(0.1).sleep();
  }
  return true;
}

namespace {

constexpr int kUsage = 2;
constexpr double kPatience = 10;  // for the master [s]

int runOrFail(const char* program, const std::function<void()>& run) {
  try {
    run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", std::filesystem::path(program).filename().c_str(), error.what());
    return kUsage;
  }
}

bool helped(int argc, const char* const* argv, const char* help) {
  if (help == nullptr || !asksForHelp(argc, argv)) return false;
  std::fputs(help, stdout);
  return true;
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& run, const char* help) {
  return runOrFail(argv[0], [&] {
    if (helped(argc, argv, help)) return;
    init(argc, argv, name);
    waitForMaster(kPatience);
    run();
  });
}

int runNodeWithGoodbye(int argc, char** argv, const std::string& name, const std::function<void()>& run,
                       const char* help) {
  return runOrFail(argv[0], [&] {
    if (helped(argc, argv, help)) return;
    initWithGoodbye(argc, argv, name);
    if (!waitForMaster(kPatience)) return;
    run();
    ros::shutdown();
  });
}

bool asksForHelp(int argc, const char* const* argv) {
  return std::any_of(argv + 1, argv + argc,
                     [](const char* word) { return std::string(word) == "--help" || std::string(word) == "-h"; });
}

std::string takeRealtimePriority(int priority) {
  const int error = setPriority(0, priority);
  return error == 0 ? "" : refusal(error, priority);
}

std::string takeRealtimePriorityForAll(int priority) {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    const int error = setPriority(std::stoi(thread.path().filename()), priority);
    if (error != 0 && error != ESRCH) return refusal(error, priority);  // ESRCH: it has ended meanwhile
  }
  return "";
}

std::string lockMemory() {
  // With a limit, memory that is asked for later would be refused, and the process would end.
  rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
  ::setrlimit(RLIMIT_MEMLOCK, &limit);  // root may
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool enough = limit.rlim_cur == RLIM_INFINITY;
  if (enough && ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
    ::mallopt(M_TRIM_THRESHOLD, -1);  // freed memory is not given back
    ::mallopt(M_MMAP_MAX, 0);         // nor are large blocks
    return "";
  }
  const std::string reason = enough ? std::strerror(errno) : "only " + std::to_string(limit.rlim_cur / 1024) + " kB";
  return "Memory is not locked: it is not permitted (" + reason + ")" + remedy("memlock unlimited");
}

std::vector<std::string> runInRealTime(int priority) {
  std::vector<std::string> refusals;
  for (const std::string& sentence : {lockMemory(), takeRealtimePriorityForAll(priority)})
    if (!sentence.empty()) refusals.push_back(sentence);
  return refusals;
}

}  // namespace vibe::ros_utils
