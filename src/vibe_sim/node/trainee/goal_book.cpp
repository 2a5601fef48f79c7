#include "trainee/goal_book.hpp"

#include <algorithm>

#include "conversions/goal_message.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

using Entry = vibe_msgs::GoalProgress;

bool isOpen(const Entry& entry) {
  return entry.state == Entry::QUEUED || entry.state == Entry::ACTIVE;
}

bool hasBite(const Observation& seen) {
  return std::any_of(seen.events.begin(), seen.events.end(),
                     [](const Event& event) { return event.kind == Event::Kind::Bite; });
}

}  // namespace

Entry& GoalBook::append(const std::string& label, const std::string& text) {
  Entry& entry = message_.goals.emplace_back();
  entry.id = static_cast<std::uint32_t>(message_.goals.size());
  entry.label = label;
  entry.goal = text;
  entry.suture = -1;
  goals_.resize(message_.goals.size());
  changed_ = true;
  return entry;
}

std::uint32_t GoalBook::add(const std::string& label, const Goal& goal) {
  Entry& entry = append(label, describe(goal));
  entry.pattern = patternOf(goal);
  goals_.back() = goal;
  return entry.id;
}

void GoalBook::refuse(const std::string& label, const std::string& text, const std::string& reason) {
  fail(reason, append(label, text));
}

void GoalBook::fail(const std::string& reason, Entry& entry) {
  entry.state = Entry::FAILED;
  entry.reason = reason;
  entry.activity.clear();
  changed_ = true;
}

void GoalBook::start(Trainee& trainee) {
  for (std::size_t k = entry_.empty() ? 0 : entry_.back() + 1; k < goals_.size(); ++k) {
    if (message_.goals[k].state != Entry::QUEUED) continue;
    try {
      trainee.add(goals_[k]);
      entry_.push_back(k);
    } catch (const Error& error) {  // what the goal needs cannot be read, such as a mesh of the device
      fail(error.what(), message_.goals[k]);
    }
  }
}

void GoalBook::abandon(const std::string& reason) {
  for (Entry& entry : message_.goals) {
    if (isOpen(entry)) fail(reason, entry);
    entry.suture = -1;  // the next session has other sutures
  }
  entry_.clear();
  ended_ = 0;
}

bool GoalBook::cancel(std::uint32_t id, Trainee* trainee) {
  bool found = false;
  for (std::size_t k = 0; k < message_.goals.size(); ++k) {
    if ((id != 0 && message_.goals[k].id != id) || !isOpen(message_.goals[k])) continue;
    cancelEntry(k, trainee);
    found = true;
  }
  return found;
}

// The active goal ends when the trainee has let go of the tissue.
void GoalBook::cancelEntry(std::size_t entry, Trainee* trainee) {
  const auto number = std::find(entry_.begin(), entry_.end(), entry);
  if (trainee && number != entry_.end()) trainee->cancel(static_cast<int>(number - entry_.begin()));
  if (message_.goals[entry].state == Entry::QUEUED) fail("cancelled", message_.goals[entry]);
}

void GoalBook::followCurrent(const Trainee& trainee, Entry& entry) {
  if (!isOpen(entry) || (entry.state == Entry::ACTIVE && entry.activity == trainee.activity())) return;
  entry.state = Entry::ACTIVE;
  entry.activity = trainee.activity();
  changed_ = true;
}

void GoalBook::follow(const Trainee& trainee, const Observation& seen) {
  if (ended_ < entry_.size() && hasBite(seen) && message_.goals[entry_[ended_]].suture != seen.sets - 1) {
    message_.goals[entry_[ended_]].suture = seen.sets - 1;
    changed_ = true;
  }
  for (; ended_ < trainee.results().size(); ++ended_) {
    Entry& entry = message_.goals[entry_[ended_]];
    const GoalResult& result = trainee.results()[ended_];
    if (!isOpen(entry)) continue;
    fail(result.reason, entry);
    if (result.reached) entry.state = Entry::REACHED;
  }
  if (ended_ < entry_.size()) followCurrent(trainee, message_.goals[entry_[ended_]]);
}

bool GoalBook::takeChange() {
  const bool changed = changed_;
  changed_ = false;
  return changed;
}

}  // namespace vibe::sim
