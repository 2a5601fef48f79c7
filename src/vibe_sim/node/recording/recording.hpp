#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <vibe_msgs/SessionInfo.h>

#include "recording/step_input_reader.hpp"

namespace vibe::sim {

/// The part of a session from one start, reset or load to the next.
struct RecordedRun {
  std::uint32_t number = 1;
  std::string scene;                             ///< text of the scene file
  std::optional<vibe_msgs::SessionInfo> info;    ///< what it was made with; empty: of an older release
  std::vector<RecordedStep> steps;               ///< consecutive; the first is step 0 or has a snapshot
  std::map<std::uint64_t, ros::Time> snapshots;  ///< by the step that starts there; time in the bag

  std::uint64_t firstStep() const { return steps.front().step; }
  std::uint64_t endStep() const { return steps.back().step + 1; }
};

/// What of a recorded session is needed to repeat it, read from the topics scene, session_info, snapshot, applied_input
/// and solver_statistics of a bag, also of older releases (StepInputReader). Inputs and hashes are in memory, snapshots
/// stay in the file.
class Recording {
 public:
  /// @throws Error if the file is missing, empty, cut off or no bag; if it holds no session; if steps are missing in
  /// it; or if it is of a version that this build does not read
  explicit Recording(const std::string& file);

  const std::string& file() const { return file_; }
  const std::vector<RecordedRun>& runs() const { return runs_; }  ///< at least one, each with at least one step
  /// Hashes of the state by the stamp of its message [ns]; 16 hex digits. Several where a reset set the time back.
  const std::multimap<std::int64_t, std::string>& stateHashes() const { return state_hashes_; }
  /// Steps before the first snapshot of a recording that began late; they cannot be repeated.
  std::size_t stepsLeftOut() const { return left_out_; }
  /// What of a later run cannot be repeated, as a sentence without a full stop; empty: nothing.
  const std::string& lost() const { return lost_; }
  const std::string& prefix() const { return prefix_; }  ///< namespace of the simulator's topics, with a slash

  /// The bytes of a snapshot.
  /// @throws Error if the bag cannot be read
  std::string snapshot(const RecordedRun& run, std::uint64_t step) const;

  rosbag::Bag& bag() const { return *bag_; }

 private:
  void readAll();
  void readMessage(const rosbag::MessageInstance& message);
  RecordedStep readStep(const rosbag::MessageInstance& message);
  RecordedRun& runOf(std::uint32_t number);
  void sortSteps(RecordedRun& run) const;
  void takeRun(RecordedRun& run);
  void check();

  std::string file_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::map<std::string, StepInputReader> readers_;  // by md5 sum of the definition
  std::map<std::uint32_t, RecordedRun> by_number_;
  std::vector<std::pair<ros::Time, std::string>> scenes_;
  std::vector<RecordedRun> runs_;
  std::multimap<std::int64_t, std::string> state_hashes_;
  std::size_t left_out_ = 0;
  std::string lost_;
  std::string prefix_ = "/";
};

/// How much of a topic a recording keeps. What a replay computes again is thinned or left out.
struct RecordingRule {
  std::string topic;  ///< without its namespace, or "type:PACKAGE/NAME" for all topics of a type
  double period;      ///< kept is one message in this time [s]; 0: all; kNever: none
  bool replayed;      ///< a replay writes all of its messages (replay --fill)
};

constexpr double kNever = -1;

/// Topics that no rule names are kept whole.
const std::vector<RecordingRule>& recordingRules();

/// The rule of a topic, or null. A rule with a name is for the topics of simulators alone: those of others are theirs.
/// @param topic     its whole name
/// @param type      of its messages; empty if it is not known
/// @param prefixes  namespaces of simulators, with a slash at the end
const RecordingRule* recordingRule(const std::string& topic, const std::string& type,
                                   const std::set<std::string>& prefixes);

/// Whether a topic's whole name is `name` in any namespace.
bool isTopic(const std::string& topic, const std::string& name);

}  // namespace vibe::sim
