#include "input/input_queue.hpp"

#include <algorithm>

namespace vibe::sim {

namespace {

// More at once, as after a stall, cost a little memory once.
constexpr std::size_t kUsuallyDue = 256;

}  // namespace

InputQueue::InputQueue() {
  due_.samples.reserve(kUsuallyDue);
}

bool InputQueue::push(const InputSample& sample) {
  const auto channel = static_cast<std::size_t>(sample.channel);
  const std::int64_t stamp = std::max(sample.stamp, applied_until_.load());
  const bool replaces = taken_[channel] > 0 && stamp == last_pushed_[channel].stamp &&
                        isOfOneNode(sample.sender, last_pushed_[channel].sender);
  if (!replaces && taken_[channel] >= kCapacity) return false;
  ++taken_[channel];
  if (!inbox_.push(sample)) {
    --taken_[channel];
    return false;
  }
  last_pushed_[channel] = {stamp, sample.sender};
  return true;
}

void InputQueue::collect() {
  inbox_.consume_all([this](const InputSample& sample) { insert(sample); });
}

void InputQueue::insert(const InputSample& sample) {
  const auto channel = static_cast<std::size_t>(sample.channel);
  Queue& queue = queues_[channel];
  InputSample item = sample;
  item.stamp = std::max(sample.stamp, applied_until_.load());
  const auto later = std::upper_bound(queue.waiting.begin(), queue.waiting.end(), item.stamp,
                                      [](std::int64_t stamp, const InputSample& other) { return stamp < other.stamp; });
  auto own = later;  // behind the one to replace
  while (own != queue.waiting.begin() && std::prev(own)->stamp == item.stamp &&
         !isOfOneNode(std::prev(own)->sender, item.sender))
    --own;
  const bool replaces = own != queue.waiting.begin() && std::prev(own)->stamp == item.stamp;
  if (replaces || queue.waiting.full()) {
    const auto place = replaces ? own : later;
    *(place == queue.waiting.begin() ? place : std::prev(place)) = item;
    --taken_[channel];
  } else {
    queue.waiting.insert(later, item);
  }
  queue.newest = std::max(queue.newest, sample.stamp);
}

void InputQueue::dropFirst(Queue& queue, std::int64_t stamp) {
  queue.last_due = stamp;
  --taken_[static_cast<std::size_t>(queue.waiting.front().channel)];
  queue.waiting.pop_front();
}

bool InputQueue::knownUntil(std::int64_t stamp) {
  collect();
  return std::all_of(queues_.begin(), queues_.begin() + kLockstepChannelCount,
                     [stamp](const Queue& queue) { return queue.newest >= stamp; });
}

std::string InputQueue::missingAt(std::int64_t stamp) {
  collect();
  std::string names;
  for (int channel = 0; channel < kLockstepChannelCount; ++channel) {
    if (queues_[channel].newest >= stamp) continue;
    names += (names.empty() ? "" : ", ") + std::string(toString(static_cast<InputChannel>(channel)));
  }
  return names;
}

void InputQueue::setBack(std::int64_t stamp) {
  for (Queue& queue : queues_) {
    for (InputSample& sample : queue.waiting) sample.stamp = std::min(sample.stamp, stamp);
    queue.newest = std::min(queue.newest, stamp);
    queue.last_due = std::min(queue.last_due, stamp);
  }
  applied_until_ = stamp;
}

const DueInput& InputQueue::takeDue(std::int64_t stamp) {
  collect();
  due_.since = applied_until_;
  due_.stamp = stamp;
  due_.samples.clear();
  if (stamp < applied_until_) setBack(stamp);
  for (std::size_t channel = 0; channel < queues_.size(); ++channel) {
    Queue& queue = queues_[channel];
    while (!queue.waiting.empty() && queue.waiting.front().stamp <= stamp) {
      due_.samples.push_back(queue.waiting.front());
      dropFirst(queue, stamp);
    }
    due_.silence[channel] = queue.waiting.empty() ? stamp - queue.last_due : 0;
  }
  applied_until_ = stamp;
  return due_;
}

void InputQueue::clear() {
  collect();
  for (std::size_t channel = 0; channel < queues_.size(); ++channel) {
    Queue& queue = queues_[channel];
    taken_[channel] -= queue.waiting.size();
    queue.waiting.clear();
    queue.newest = 0;
    queue.last_due = 0;
  }
  applied_until_ = 0;
}

}  // namespace vibe::sim
