#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vibe::ros_utils {

/// What is wrong with the folder for logs that ros::init() makes, and the remedy, as one sentence; empty: nothing.
[[nodiscard]] std::string logFolderFault();

/// ros::init(), where that could say only in the words of a library what is missing.
/// @throws Error if it cannot make the folder for logs
void init(int& argc, char** argv, const std::string& name, std::uint32_t options = 0);

/// init() for a node that says goodbye, for example that releases its buttons: SIGINT and SIGTERM are only noted, while
/// roscpp's own handler would close the topics first. Such a node looks at stopSignal().
void initWithGoodbye(int& argc, char** argv, const std::string& name, std::uint32_t options = 0);

/// The signal that has been noted, 0: none. Always 0 without initWithGoodbye().
int stopSignal();

/// Sleeps until a signal is noted or roscpp ends.
void waitForStop();

/// Waits for an answer of the ROS master. Call it after init() and before the first NodeHandle, which waits for a
/// master for ever and hears no signal meanwhile. Says once that it waits.
/// @param patience  [s]
/// @return whether there is a master; false: a signal was noted
/// @throws Error when none has answered in time
bool waitForMaster(double patience);

/// The main() of a node: init(), waiting for the master, and what the node does. What these throw is said on the
/// standard error, after the name of the program.
/// @param help  printed instead, where the command line asks for it; null: there is none
/// @return the status of the program: 0, or 2 after an error
int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& run,
            const char* help = nullptr);

/// The same with initWithGoodbye(), and ros::shutdown() when `run` has returned.
int runNodeWithGoodbye(int argc, char** argv, const std::string& name, const std::function<void()>& run,
                       const char* help = nullptr);

/// Whether the command line has --help or -h.
bool asksForHelp(int argc, const char* const* argv);

/// Gives the calling thread the real-time priority of SCHED_FIFO, so that no ordinary program delays it. Threads that
/// it starts later have it too.
/// @param priority  1 (lowest) to 99
/// @return empty, or one sentence that says why not and what to do
[[nodiscard]] std::string takeRealtimePriority(int priority);

/// The same for all threads that this process has now, such as those of ROS, which have locks that others wait for.
[[nodiscard]] std::string takeRealtimePriorityForAll(int priority);

/// Locks the memory of this process, what it has and what it will get, and keeps freed memory, so that no step waits
/// for a page.
/// @return empty, or one sentence that says why not and what to do
[[nodiscard]] std::string lockMemory();

/// What a node with a real-time priority does first: locks its memory and gives the priority to all threads it has.
/// Those that come later inherit it.
/// @return one sentence for each that is not permitted
[[nodiscard]] std::vector<std::string> runInRealTime(int priority);

}  // namespace vibe::ros_utils
