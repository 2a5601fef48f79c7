#pragma once
#include <string>
#include <vector>

namespace vibe::node {

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

}  // namespace vibe::node
