#include "vibe_hardware/driver/device_connection.hpp"

#include <cmath>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware {
namespace {

using vibe_firmware::AxisConfig;
using vibe_firmware::Refusal;

constexpr std::size_t kLargestReport = 64;
constexpr const char* kInstall = "; its firmware may be of another release: install that of this one.";

std::string number(double value) {
  return formatted("%.4g", value);
}

[[noreturn]] void failUnanswered(const std::string& request, const NoAnswer& silence) {
  throw Error("It does not answer " + request + " in time (" + silence.what() +
              "); check the cable and plug the device in again.");
}

/// What the host computes with. The firmware was built with it, but the answer came over a cable.
bool isSane(const AxisConfig& axis) {
  const auto within = [](float value, float low, float high) { return value >= low && value <= high; };
  return within(axis.sample_period, 1e-5F, 0.1F) && within(std::abs(axis.radians_per_count), 1e-9F, 1.0F) &&
         within(axis.full_scale, 1e-6F, 1e6F) && within(axis.viscous_friction, 0, 1e3F) &&
         within(axis.coulomb_friction, 0, 1e3F) && within(axis.torque_limit, 0, 1e3F) &&
         within(axis.velocity_pole, 0, 0.99999F) && within(axis.output_delay, 0, 1) &&
         within(axis.safety_factor, 1, 1e3F);
}

}  // namespace

DeviceConnection::DeviceConnection(std::unique_ptr<HidPort> port, const HidInfo& info, DeviceKind kind)
    : port_(std::move(port)), info_(info), kind_(kind) {
  const std::vector<std::uint8_t> descriptor = port_->reportDescriptor();
  if (!descriptor.empty()) checkReportDescriptor(descriptor.data(), descriptor.size(), kind_);
  refreshStatus();
  if (status_.protocol != vibe_firmware::kProtocolVersion) {
    throw Error("Its firmware " + firmwareVersion() + " speaks version " + std::to_string(status_.protocol) +
                " of the protocol, this driver version " + std::to_string(vibe_firmware::kProtocolVersion) +
                "; install firmware and driver of the same release.");
  }
  for (int axis = 0; axis < vibe_firmware::kAxisCount; ++axis) readAxis(axis);
}

std::string DeviceConnection::firmwareVersion() const {
  const auto& v = status_.version;
  return std::to_string(v[0]) + "." + std::to_string(v[1]) + "." + std::to_string(v[2]);
}

template <class Report, std::size_t Size>
void DeviceConnection::get(std::uint8_t id, const char* name, Report& report) {
  std::uint8_t bytes[kLargestReport + 1] = {};
  std::size_t size = 0;
  try {
    size = port_->getFeature(id, bytes, sizeof bytes);
  } catch (const ReportRejected& rejection) {
    throw Error(std::string("It rejects the request for ") + name + " (" + rejection.what() + ")" + kInstall);
  } catch (const NoAnswer& silence) {
    failUnanswered(std::string("the request for ") + name, silence);
  }
  if (size <= sizeof bytes && vibe_firmware::unpack(bytes, size, report)) return;
  throw Error(std::string("Its ") + name + " has " + std::to_string(size) + " bytes and id " +
              std::to_string(bytes[0]) + " instead of " + std::to_string(Size) + " and " + std::to_string(id) +
              kInstall);
}

void DeviceConnection::readAxis(int axis) {
  vibe_firmware::AxisReport report;
  const auto id = static_cast<std::uint8_t>(vibe_firmware::kAxisReportId + axis);
  get<vibe_firmware::AxisReport, vibe_firmware::kAxisReportSize>(id, "configuration of an axis", report);
  if (report.axis != axis || !isSane(report.config)) {
    throw Error("The configuration of its axis " + std::to_string(axis) + " has values out of range" + kInstall);
  }
  axes_[static_cast<std::size_t>(axis)] = report.config;
}

void DeviceConnection::refreshStatus() {
  get<vibe_firmware::StatusReport, vibe_firmware::kStatusReportSize>(vibe_firmware::kStatusReportId, "status", status_);
}

vibe_firmware::ParameterReport DeviceConnection::readParameters() {
  vibe_firmware::ParameterReport report;
  get<vibe_firmware::ParameterReport, vibe_firmware::kParameterReportSize>(vibe_firmware::kParameterReportId,
                                                                           "parameters", report);
  return report;
}

void DeviceConnection::sendParameters(const vibe_firmware::ParameterReport& parameters) {
  std::uint8_t bytes[vibe_firmware::kParameterReportSize];
  vibe_firmware::pack(parameters, bytes);
  try {
    port_->setFeature(bytes, sizeof bytes);
  } catch (const ReportRejected& rejection) {
    throw Error(std::string("It rejects the form of the parameters (") + rejection.what() + ")" + kInstall);
  } catch (const NoAnswer& silence) {
    failUnanswered("the parameters", silence);
  }
}

std::string describe(const vibe_firmware::Verdict& verdict) {
  const std::string axis = "axis " + std::to_string(verdict.axis) + ": ";
  const std::string value = number(verdict.value), limit = number(verdict.limit);
  switch (verdict.refusal) {
    case Refusal::None:
      return "nothing was refused";
    case Refusal::NotFinite:
      return axis + "a value is not finite";
    case Refusal::Negative:
      return axis + "stiffness, damping or torque limit is negative (" + value + ")";
    case Refusal::TorqueLimit:
      return axis + "torque " + value + " N m is above the limit of " + limit + " N m";
    case Refusal::ViscousFriction:
      return axis + "stiffness and damping would need a viscous friction of " + value + " N m s/rad, the axis has " +
             limit;
    case Refusal::CoulombFriction:
      return axis + "stiffness and damping would need a Coulomb friction of " + value + " N m, the axis has " + limit;
    case Refusal::Position:
      return axis + "position " + value + " rad is beyond the encoder's " + limit + " rad";
  }
  return axis + "for the unknown reason " + std::to_string(static_cast<int>(verdict.refusal));
}

}  // namespace vibe::hardware
