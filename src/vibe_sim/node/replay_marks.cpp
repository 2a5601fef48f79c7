#include "replay_marks.hpp"

#include <rosbag/view.h>
#include <vibe_msgs/ProcedureEvent.h>

#include <algorithm>
#include <map>

#include "conversions.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe::sim {
namespace {

using EventMessage = vibe_msgs::ProcedureEvent;

// Empty for kinds that are too frequent to be marked.
std::string nameOf(const EventMessage& event) {
  static const std::map<int, std::string> names = {{EventMessage::MARK, "mark"},
                                                   {EventMessage::BURN, "burn"},
                                                   {EventMessage::BITE, "bite"},
                                                   {EventMessage::SLIP, "slip"},
                                                   {EventMessage::T_TAG_DROPPED, "T-tag"},
                                                   {EventMessage::CINCHED, "cinched"},
                                                   {EventMessage::TEAR_OUT, "tear-out"},
                                                   {EventMessage::CINCH_LOOSE, "loose"},
                                                   {EventMessage::THREAD_BROKE, "thread broke"},
                                                   {EventMessage::BLEEDING_BRISK, "bleeding"}};
  if (event.kind == EventMessage::PHASE_CHANGED)
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
      const auto event = message.instantiate<EventMessage>();
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

}  // namespace vibe::sim
