#include "lockstep.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "scenario.hpp"

namespace vibe_firmware {

namespace {

std::string valuesOf(const CosimReply& reply) {
  std::ostringstream text;
  text << std::setprecision(9) << "torque " << reply.torque[0] << " " << reply.torque[1] << ", position "
       << reply.position[0] << " " << reply.position[1] << ", velocity " << reply.velocity[0] << " "
       << reply.velocity[1] << ", energy " << reply.energy[0] << " " << reply.energy[1];
  return text.str();
}

}  // namespace

void writeTrace(const std::string& file, const std::vector<CosimReply>& trace) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(trace.data()),
            static_cast<std::streamsize>(trace.size() * sizeof(CosimReply)));
  if (!out.flush()) throw std::runtime_error(file + " cannot be written");
}

std::vector<CosimReply> readTrace(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file + " cannot be opened");
  std::vector<CosimReply> trace;
  CosimReply reply;
  while (in.read(reinterpret_cast<char*>(&reply), sizeof reply)) trace.push_back(reply);
  if (in.gcount() != 0) throw std::runtime_error(file + " ends within a tick");
  return trace;
}

std::string firstDifference(const std::vector<CosimReply>& one, const std::vector<CosimReply>& other) {
  std::ostringstream text;
  if (one.size() != other.size()) text << one.size() << " ticks and " << other.size() << " ticks; ";
  for (std::size_t i = 0; i < one.size() && i < other.size(); ++i) {
    if (std::memcmp(&one[i], &other[i], sizeof one[i]) == 0) continue;
    text << "tick " << i << " differs: (" << valuesOf(one[i]) << ") and (" << valuesOf(other[i]) << ")";
    break;
  }
  return text.str();
}

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
