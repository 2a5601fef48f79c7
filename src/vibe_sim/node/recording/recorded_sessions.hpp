#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <vibe_msgs/SessionInfo.h>

#include "recording/step_input_reader.hpp"

namespace vibe::sim {

/// The part of a session from one start, reset or load to the next; of a recording with gaps, what lies between two.
struct RecordedRun {
  std::uint32_t number = 1;
  std::string scene;                             ///< text of the scene file
  std::optional<vibe_msgs::SessionInfo> info;    ///< what it was made with; empty: not recorded
  std::vector<RecordedStep> steps;               ///< consecutive; the first is step 0 or has a snapshot
  std::map<std::uint64_t, ros::Time> snapshots;  ///< by the step that starts there; time in the bag

  std::uint64_t firstStep() const { return steps.front().step; }
  std::uint64_t endStep() const { return steps.back().step + 1; }
};

/// One start of a simulator, as far as it was recorded.
struct RecordedSession {
  std::string prefix = "/";                         ///< namespace of its topics, with a slash at the end
  std::uint64_t id = 0;                             ///< see vibe_msgs/SessionInfo; 0: of a release without them
  ros::Time begin, end;                             ///< times in the bag of its first and last step
  std::map<std::uint32_t, RecordedRun> runs;        ///< as recorded: in any order, with gaps
  std::multimap<std::int64_t, std::string> hashes;  ///< of the state, by stamp [ns]; 16 hexadecimal digits
  std::string scene;                                ///< of the topic scene, for runs without session_info

  std::size_t stepCount() const;
  std::string nameSpace() const;  ///< "/left"; "/" for the root
  std::string idText() const;     ///< 16 hexadecimal digits; "-" without one
};

/// Bags that are read as one, such as the parts of a split recording; by the times of their messages.
using Bags = std::vector<std::shared_ptr<rosbag::Bag>>;

/// The messages of all bags on which the query is true.
std::unique_ptr<rosbag::View> viewOf(const Bags& bags,
                                     const boost::function<bool(const rosbag::ConnectionInfo*)>& query);

/// All sessions with at least one step, the one that was started first in front. Sessions are told apart by identity
/// and namespace. Those of older releases have no identity: where the steps of a run begin anew, a session does.
/// @param name  of the recording, for errors
/// @throws Error if a step cannot be read, or comes twice with different content
std::vector<RecordedSession> readSessions(const Bags& bags, const std::string& name);

/// A message whose type has got fields at its end since this recording was made; they are 0.
/// @return null for another type, or for a definition that is not known
template <class M>
boost::shared_ptr<M> instantiateGrown(const rosbag::MessageInstance& message, const char* former_md5) {
  if (message.getMD5Sum() != former_md5) return message.instantiate<M>();
  std::vector<std::uint8_t> bytes(message.size() + sizeof(std::uint64_t));
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  auto result = boost::make_shared<M>();
  ros::serialization::deserialize(in, *result);
  return result;
}

/// MD5 sum of vibe_msgs/StateSnapshot before it had an identity.
inline constexpr const char* kFormerSnapshot = "b55268b4f8de9782e13eb08f44c66a10";

/// Of the messages that have one, which session they are of; empty for others.
std::optional<std::uint64_t> identityOf(const rosbag::MessageInstance& message);

/// Whether a topic's whole name is `name` in any namespace.
bool isTopic(const std::string& topic, const std::string& name);

}  // namespace vibe::sim
