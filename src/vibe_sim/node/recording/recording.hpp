#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "publishing/message_sink.hpp"
#include "recording/recorded_sessions.hpp"

namespace vibe::sim {

/// Which session of a recording is meant.
struct SessionChoice {
  std::string name_space;  ///< of the simulator's topics; empty: any
  std::string session;     ///< its number in the list, or the beginning of its identity; empty: the first
};

/// What of a recorded session is needed to repeat it, read from the topics scene, session_info, snapshot, applied_input
/// and solver_statistics of a bag, also of older releases (StepInputReader). Inputs and hashes are in memory, snapshots
/// stay in the file.
class Recording {
 public:
  /// @param files  one bag, or the parts of a split one, in any order
  /// @throws Error if a file is missing, empty, cut off or no bag; if no session is the chosen one; if what a replay
  /// needs is missing, by its name; or if it is of a version that this build does not read
  explicit Recording(const std::vector<std::string>& files, const SessionChoice& choice = {});
  explicit Recording(const std::string& file, const SessionChoice& choice = {});

  const std::string& file() const { return file_; }  ///< the first one
  /// All sessions, without their runs.
  const std::vector<RecordedSession>& sessions() const { return sessions_; }
  const RecordedSession& session() const { return sessions_[chosen_]; }  ///< the chosen one
  /// That there are others, as a sentence; empty if this is the only one.
  std::string remarkOnChoice() const;

  const std::vector<RecordedRun>& runs() const { return runs_; }  ///< at least one, each with at least one step
  /// Hashes of the state by the stamp of its message [ns]; 16 hex digits. Several where a reset set the time back.
  const std::multimap<std::int64_t, std::string>& stateHashes() const { return session().hashes; }
  /// Steps before the first snapshot; they cannot be repeated.
  std::size_t stepsLeftOut() const { return left_out_; }
  /// What of a later part cannot be repeated, as a sentence without a full stop; empty: nothing.
  const std::string& lost() const { return lost_; }
  const std::string& prefix() const { return session().prefix; }  ///< namespace of its topics, with a slash

  /// The bytes of a snapshot.
  /// @throws Error if the bag cannot be read
  std::string snapshot(const RecordedRun& run, std::uint64_t step) const;

  /// The messages on which the query is true. @see viewOf()
  std::unique_ptr<rosbag::View> view(const boost::function<bool(const rosbag::ConnectionInfo*)>& query) const {
    return viewOf(bags_, query);
  }

 private:
  /// Steps that something is wrong with.
  struct Count {
    std::size_t steps = 0, places = 0;
    std::string first;  // place

    void add(std::size_t more, const std::string& place) {
      if (places++ == 0) first = place;
      steps += more;
    }
  };

  void choose(const SessionChoice& choice);
  void takeRuns();
  void takeRun(RecordedRun& run);
  void takePiece(const RecordedRun& run, std::vector<RecordedStep> steps, bool is_first);
  void lose(const std::string& what);
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuseWithoutInputs() const;
  [[noreturn]] void refuseWithoutBegin(std::size_t snapshots) const;

  std::string file_;
  Bags bags_;
  std::vector<RecordedSession> sessions_;
  std::size_t chosen_ = 0;
  bool is_chosen_ = false;  // among several
  std::vector<RecordedRun> runs_;
  std::size_t left_out_ = 0;
  Count gaps_, unreachable_;
  std::string lost_;
};

/// All sessions of a bag, or of the parts of a split one, also those that cannot be replayed.
/// @throws Error if a file is missing, empty, cut off or no bag, or of a version that this build does not read
std::vector<RecordedSession> listSessions(const std::vector<std::string>& files);

/// Of the topics of the simulator, as Publishers has them, and of types that others publish. Topics that no rule names
/// are kept whole.
const std::vector<RecordingRule>& recordingRules();

/// The rule of a topic, or null. A rule with a name is for the topics of simulators alone: those of others are theirs.
/// @param topic     its whole name
/// @param type      of its messages; empty if it is not known
/// @param prefixes  namespaces of simulators, with a slash at the end
const RecordingRule* recordingRule(const std::string& topic, const std::string& type,
                                   const std::set<std::string>& prefixes);

}  // namespace vibe::sim
