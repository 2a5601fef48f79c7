#include "lockstep.hpp"

#include <algorithm>

#include "control_requests.hpp"

namespace vibe_firmware {

Lockstep::Lockstep(FirmwarePeer& firmware, Scenario& scenario, std::uint32_t delay)
    : firmware_(firmware), scenario_(scenario), delay_(delay) {
  for (const PlantConfig& plant : scenario.plants()) plants_.emplace_back(plant);
}

void Lockstep::run(std::uint32_t ticks) {
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    const CosimReply reply = firmware_.exchange(requestOf(tick));
    keep(reply);
    scenario_.receive(reply);
    late_.push_back(reply);
    advance(tick, late_.front());
    if (late_.size() > delay_) late_.pop_front();
  }
}

CosimRequest Lockstep::requestOf(std::uint32_t tick) {
  CosimRequest request;
  if (tick == 0)
    setConfiguration(request);
  else
    scenario_.command(tick, request);
  request.time_us = 1000 * tick;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    const AxisPlant& plant = plants_[axis];
    request.counter[axis] = static_cast<std::uint32_t>(plant.count()) & 0xFFFF;
    request.index_counter[axis] = plant.indexCounter() & 0xFFFF;
    if (plant.index()) request.index = static_cast<std::uint8_t>(request.index | 1U << axis);
  }
  return request;
}

void Lockstep::keep(CosimReply reply) {
  if (!trace_.empty()) {
    const std::uint32_t period = reply.entry_counts - last_entry_;
    shortest_ = std::min(shortest_, period);
    longest_ = std::max(longest_, period);
  }
  last_entry_ = reply.entry_counts;
  reply.entry_counts = 0;
  trace_.push_back(reply);
}

void Lockstep::advance(std::uint32_t tick, const CosimReply& reply) {
  for (int axis = 0; axis < kAxisCount; ++axis) {
    AxisPlant& plant = plants_[static_cast<std::size_t>(axis)];
    const double before = plant.position();
    const HandAction action = scenario_.hand(tick, axis, plant);
    const double high = static_cast<double>(reply.first[axis]) - static_cast<double>(reply.second[axis]);
    if (action.holds)
      plant.moveTo(action.position);
    else
      plant.advance(high / kCosimPwmPeriod, action.torque);
    scenario_.observe({tick, axis, reply.torque[axis], before, plant.position()});
  }
}

std::uint64_t Lockstep::hash() const {
  std::uint64_t hash = 0xCBF29CE484222325;
  const auto* bytes = reinterpret_cast<const unsigned char*>(trace_.data());
  for (std::size_t i = 0; i < trace_.size() * sizeof(CosimReply); ++i) hash = (hash ^ bytes[i]) * 0x100000001B3;
  return hash;
}

}  // namespace vibe_firmware
