#include "vibe_firmware/protocol/reports.hpp"

#include <cstring>

namespace vibe_firmware {
namespace {

// Writes and reads the same list of fields, so that both directions agree by construction.
class Writer {
 public:
  explicit Writer(std::uint8_t* bytes) : next_(bytes) {}
  void operator()(std::uint8_t value) { *next_++ = value; }
  void operator()(std::uint16_t value) { integer(value, 2); }
  void operator()(std::uint32_t value) { integer(value, 4); }
  void operator()(std::int16_t value) { integer(static_cast<std::uint16_t>(value), 2); }
  void operator()(std::int32_t value) { integer(static_cast<std::uint32_t>(value), 4); }
  void operator()(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    integer(bits, 4);
  }

 private:
  void integer(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) *next_++ = static_cast<std::uint8_t>(value >> 8 * i);
  }
  std::uint8_t* next_;
};

class Reader {
 public:
  explicit Reader(const std::uint8_t* bytes) : next_(bytes) {}
  void operator()(std::uint8_t& value) { value = *next_++; }
  void operator()(std::uint16_t& value) { value = static_cast<std::uint16_t>(integer(2)); }
  void operator()(std::uint32_t& value) { value = integer(4); }
  void operator()(std::int16_t& value) { value = static_cast<std::int16_t>(integer(2)); }
  void operator()(std::int32_t& value) { value = static_cast<std::int32_t>(integer(4)); }
  void operator()(float& value) {
    const std::uint32_t bits = integer(4);
    std::memcpy(&value, &bits, sizeof value);
  }

 private:
  std::uint32_t integer(int size) {
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(*next_++) << 8 * i;
    return value;
  }
  const std::uint8_t* next_;
};

template <typename Visit, typename Report>
void inputFields(Visit& visit, Report& report) {
  for (auto& axis : report.axes) visit(axis);
  visit(report.buttons);
  visit(report.sequence);
  visit(report.time_us);
  for (auto& count : report.counts) visit(count);
  for (auto& torque : report.torque) visit(torque);
  visit(report.flags);
  visit(report.parameter_number);
}

template <typename Visit, typename Report>
void parameterFields(Visit& visit, Report& report) {
  visit(report.number);
  for (auto& axis : report.axes) {
    visit(axis.stiffness);
    visit(axis.damping);
    visit(axis.position);
    visit(axis.torque);
    visit(axis.torque_limit);
  }
}

// @param refusal  report.refusal.refusal as the byte of the report
template <typename Visit, typename Report, typename Byte>
void statusFields(Visit& visit, Report& report, Byte& refusal) {
  visit(report.protocol);
  for (auto& part : report.version) visit(part);
  visit(report.flags);
  visit(report.parameter_number);
  visit(report.refused_number);
  visit(refusal);
  visit(report.refusal.axis);
  visit(report.refusal.value);
  visit(report.refusal.limit);
  visit(report.accepted);
  visit(report.refused);
  visit(report.late_ticks);
}

template <typename Visit, typename Config>
void configFields(Visit& visit, Config& config) {
  visit(config.sample_period);
  visit(config.radians_per_count);
  visit(config.full_scale);
  visit(config.viscous_friction);
  visit(config.coulomb_friction);
  visit(config.torque_limit);
  visit(config.slew_limit);
  visit(config.velocity_pole);
  visit(config.output_delay);
  visit(config.safety_factor);
  visit(config.energy_capacity);
  visit(config.speed_limit);
  visit(config.counts_per_turn);
}

bool isReport(const std::uint8_t* bytes, std::size_t size, std::uint8_t id, std::size_t expected) {
  return bytes != nullptr && size == expected && bytes[0] == id;
}

}  // namespace

std::size_t pack(const InputReport& report, std::uint8_t (&bytes)[kInputReportSize]) {
  bytes[0] = kInputReportId;
  Writer writer(bytes + 1);
  inputFields(writer, report);
  return kInputReportSize;
}

std::size_t pack(const ParameterReport& report, std::uint8_t (&bytes)[kParameterReportSize]) {
  bytes[0] = kParameterReportId;
  Writer writer(bytes + 1);
  parameterFields(writer, report);
  return kParameterReportSize;
}

std::size_t pack(const StatusReport& report, std::uint8_t (&bytes)[kStatusReportSize]) {
  bytes[0] = kStatusReportId;
  Writer writer(bytes + 1);
  const auto refusal = static_cast<std::uint8_t>(report.refusal.refusal);
  statusFields(writer, report, refusal);
  return kStatusReportSize;
}

std::size_t pack(const AxisReport& report, std::uint8_t (&bytes)[kAxisReportSize]) {
  bytes[0] = static_cast<std::uint8_t>(kAxisReportId + report.axis);
  Writer writer(bytes + 1);
  configFields(writer, report.config);
  return kAxisReportSize;
}

bool unpack(const std::uint8_t* bytes, std::size_t size, InputReport& report) {
  if (!isReport(bytes, size, kInputReportId, kInputReportSize)) return false;
  Reader reader(bytes + 1);
  inputFields(reader, report);
  return true;
}

bool unpack(const std::uint8_t* bytes, std::size_t size, ParameterReport& report) {
  if (!isReport(bytes, size, kParameterReportId, kParameterReportSize)) return false;
  Reader reader(bytes + 1);
  parameterFields(reader, report);
  return true;
}

bool unpack(const std::uint8_t* bytes, std::size_t size, StatusReport& report) {
  if (!isReport(bytes, size, kStatusReportId, kStatusReportSize)) return false;
  Reader reader(bytes + 1);
  std::uint8_t refusal = 0;
  statusFields(reader, report, refusal);
  report.refusal.refusal = static_cast<Refusal>(refusal);
  return true;
}

bool unpack(const std::uint8_t* bytes, std::size_t size, AxisReport& report) {
  for (std::uint8_t axis = 0; axis < kAxisCount; ++axis) {
    if (!isReport(bytes, size, static_cast<std::uint8_t>(kAxisReportId + axis), kAxisReportSize)) continue;
    report.axis = axis;
    Reader reader(bytes + 1);
    configFields(reader, report.config);
    return true;
  }
  return false;
}

}  // namespace vibe_firmware
