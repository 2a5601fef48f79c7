#include "input/input_queue.hpp"

#include <algorithm>
#include <utility>

namespace vibe::sim {

namespace {

// More at once, as after a stall, cost a little memory once.
constexpr std::size_t kUsuallyDue = 256, kUsualNodes = 8;

/// Whether a sample takes the place of one that waits, both with the stamps for which they wait.
bool replaces(const InputSample& sample, const InputSample& waiting) {
  return sample.stamp == waiting.stamp && isOfOneNode(sample.sender, waiting.sender) &&
         (sample.channel != InputChannel::Buttons || sample.buttons == waiting.buttons);
}

}  // namespace

InputQueue::InputQueue() {
  due_.samples.reserve(kUsuallyDue);
  for (Queue& queue : queues_) queue.newest_of.reserve(kUsualNodes);
}

bool InputQueue::push(const InputSample& sample) {
  const auto channel = static_cast<std::size_t>(sample.channel);
  InputSample item = sample;
  item.stamp = std::max(sample.stamp, applied_until_.load());
  if (!(taken_[channel] > 0 && replaces(item, last_pushed_[channel])) && taken_[channel] >= kCapacity) return false;
  ++taken_[channel];
  if (!inbox_.push(sample)) {
    --taken_[channel];
    return false;
  }
  last_pushed_[channel] = item;
  return true;
}

void InputQueue::collect() {
  inbox_.consume_all([this](const InputSample& sample) { insert(sample); });
}

void InputQueue::insert(const InputSample& sample) {
  const auto channel = static_cast<std::size_t>(sample.channel);
  Queue& queue = queues_[channel];
  queue.newest = std::max(queue.newest, sample.stamp);
  if (isOvertaken(sample)) {
    --taken_[channel];
    return;
  }
  InputSample item = sample;
  item.stamp = std::max(sample.stamp, applied_until_.load());
  const auto later = std::upper_bound(queue.waiting.begin(), queue.waiting.end(), item.stamp,
                                      [](std::int64_t stamp, const InputSample& other) { return stamp < other.stamp; });
  auto own = later;  // behind the one to replace
  while (own != queue.waiting.begin() && std::prev(own)->stamp == item.stamp &&
         !isOfOneNode(std::prev(own)->sender, item.sender))
    --own;
  const bool replaced = own != queue.waiting.begin() && replaces(item, *std::prev(own));
  if (replaced || queue.waiting.full()) {
    const auto place = replaced ? own : later;
    *(place == queue.waiting.begin() ? place : std::prev(place)) = item;
    --taken_[channel];
  } else {
    queue.waiting.insert(later, item);
  }
}

bool InputQueue::isOvertaken(const InputSample& sample) {
  const std::int64_t now = applied_until_;
  if (sample.channel == InputChannel::Buttons || sample.stamp == 0 || sample.stamp > now) return false;
  const auto channel = static_cast<std::size_t>(sample.channel);
  for (const Newest& newest : queues_[channel].newest_of) {
    if (!isOfOneNode(newest.sender, sample.sender) || sample.stamp >= newest.stamp || now - newest.used > kOvertakes)
      continue;
    overtaken_[channel] = OvertakenSample{sample, newest.stamp};
    return true;
  }
  count(queues_[channel], sample, now);
  return false;
}

void InputQueue::count(Queue& queue, const InputSample& sample, std::int64_t now) {
  auto& all = queue.newest_of;
  const auto ends = [&](const Newest& each) {
    return isOfOneNode(each.sender, sample.sender) || now - each.used > kOvertakes;
  };
  all.erase(std::remove_if(all.begin(), all.end(), ends), all.end());
  all.push_back({sample.sender, sample.stamp, now});
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
    queue.newest_of.clear();
  }
  applied_until_ = stamp;
}

const DueInput& InputQueue::takeDue(std::int64_t stamp) {
  collect();
  due_.since = applied_until_;
  due_.stamp = stamp;
  due_.samples.clear();
  due_.overtaken = std::exchange(overtaken_, {});
  if (stamp < applied_until_) setBack(stamp);
  for (std::size_t channel = 0; channel < queues_.size(); ++channel) {
    Queue& queue = queues_[channel];
    while (!queue.waiting.empty() && queue.waiting.front().stamp <= stamp) {
      const InputSample& first = queue.waiting.front();
      due_.samples.push_back(first);
      if (first.stamp > due_.since) count(queue, first, stamp);  // who was late counts since it came
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
    queue.newest_of.clear();
  }
  overtaken_ = {};
  applied_until_ = 0;
}

}  // namespace vibe::sim
