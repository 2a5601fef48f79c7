#include "replay_marks.hpp"

#include <rosbag/view.h>
#include <vibe_msgs/ProcedureEvent.h>

#include <algorithm>
#include <map>

#include "conversions.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {
namespace {

using Message = vibe_msgs::ProcedureEvent;

// Empty for kinds that are too frequent to be marked.
std::string nameOf(const Message& event) {
  static const std::map<int, std::string> names = {{Message::MARK, "mark"},
                                                   {Message::BURN, "burn"},
                                                   {Message::BITE, "bite"},
                                                   {Message::SLIP, "slip"},
                                                   {Message::T_TAG_DROPPED, "T-tag"},
                                                   {Message::CINCHED, "cinched"},
                                                   {Message::TEAR_OUT, "tear-out"},
                                                   {Message::CINCH_LOOSE, "loose"},
                                                   {Message::THREAD_BROKE, "thread broke"},
                                                   {Message::BLEEDING_BRISK, "bleeding"}};
  if (event.kind == Message::PHASE_CHANGED)
    return std::string("phase ") + toString(static_cast<Phase>(static_cast<int>(event.value)));
  const auto found = names.find(event.kind);
  return found == names.end() ? "" : found->second;
}

}  // namespace

std::vector<ReplayMark> readMarks(const Recording& recording) {
  const std::int64_t origin = recording.runs().front().steps.front().stamp;
  std::vector<ReplayMark> marks;
  try {
    for (const rosbag::MessageInstance& message :
         rosbag::View(recording.bag(), rosbag::TopicQuery(recording.prefix() + "procedure/events"))) {
      const auto event = message.instantiate<Message>();
      if (!event) continue;
      const std::string name = nameOf(*event);
      if (!name.empty()) marks.push_back({1e-9 * static_cast<double>(fromRosTime(event->header.stamp) - origin), name});
    }
  } catch (const std::exception& error) {
    throw Error("Recording '" + recording.file() + "' is damaged (" + error.what() + ").");
  }
  std::stable_sort(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return marks;
}

}  // namespace vibe
