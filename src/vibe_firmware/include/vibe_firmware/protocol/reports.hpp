#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "vibe_firmware/core/axis.hpp"

// Reports that the devices and the host exchange over USB HID. One layout serves both devices; numbers are
// little-endian, floats IEEE 754 binary32, without padding. Byte 0 is always the report id.
//
// `pack()` writes a whole report and returns its size. `unpack()` reads one and returns false, with the target left as
// it was, if the id or the size is not that of the report; it does not judge values: see validate() for parameters.

namespace vibe_firmware {

constexpr std::uint8_t kProtocolVersion = 1;  ///< of all reports here; a host accepts no other

/// Byte 0 of a report.
enum ReportId : std::uint8_t {
  kInputReportId = 1,      ///< input: one sample, every 10 ms
  kParameterReportId = 2,  ///< feature, set and get: parameters of both axes
  kStatusReportId = 3,     ///< feature, get: version, counters, last refusal
  kAxisReportId = 4,       ///< feature, get: configuration of axis 0; kAxisReportId + 1: of axis 1
};

/// One sample of a device.
///
/// | byte | type | content |
/// |---|---|---|
/// | 0 | uint8 | 1 |
/// | 1, 3 | int16 | X, Y of a gamepad: position / full scale of the axis, clamped to +-32767 |
/// | 5 | uint16 | buttons, one bit each |
/// | 7 | uint16 | sequence number, one more with each report; 0 after 65535 |
/// | 9 | uint32 | time of the sample [us] since the device started; wraps after 71.6 min |
/// | 13, 17 | int32 | encoder counts, unwrapped; index-corrected once the index has been seen |
/// | 21, 23 | int16 | torque commanded in the last tick [10 uN m] |
/// | 25 | uint8 | DeviceFlag bits |
/// | 26 | uint16 | number of the parameter set in force |
struct InputReport {
  std::array<std::int16_t, kAxisCount> axes{};  ///< X, Y of a gamepad: 32767 is the full scale
  std::uint16_t buttons = 0;                    ///< debounced, one bit each; 1 while pressed
  std::uint16_t sequence = 0;                   ///< one more with each report; 0 after 65535
  std::uint32_t time_us = 0;  ///< of the sample, since the start of the device; wraps after 71.6 min [us]
  std::array<std::int32_t, kAxisCount> counts{};  ///< of the encoders, unwrapped; 0 at the start
  std::array<std::int16_t, kAxisCount> torque{};  ///< [kTorqueUnit]
  std::uint8_t flags = 0;                         ///< DeviceFlag bits, of the last tick
  std::uint16_t parameter_number = 0;             ///< of the set in force; 0 before the first one
};
constexpr std::size_t kInputReportSize = 28;  ///< bytes, its id included
constexpr float kTorqueUnit = 1e-5F;          ///< of InputReport::torque [N m]

/// Bits of InputReport::flags and StatusReport::flags.
enum DeviceFlag : std::uint8_t {
  kHostSilent = 1,     ///< no valid parameters for 200 ms: the spring is ramped to zero, damping stays
  kLimited = 2,        ///< torque or slew limit acts
  kPassivityActs = 4,  ///< the passivity controller acts
  kRefused = 8,        ///< the last parameters were refused; StatusReport says why
  kIndexed0 = 16,      ///< the encoder index of axis 0 has been seen
  kIndexed1 = 32,      ///< the same of axis 1
  kDriveFault = 128,   ///< the power stage of the motors has switched off (overcurrent, heat, supply)
  kEncoderFault = 64,  ///< an encoder jumped by more than is physically possible: torque is off
};

/// Parameters of both axes.
///
/// | byte | type | content |
/// |---|---|---|
/// | 0 | uint8 | 2 |
/// | 1 | uint16 | number of the set, chosen by the host |
/// | 3 + 20 a | 5 float32 | of axis a: stiffness, damping, position, torque, torque limit (AxisParameters) |
struct ParameterReport {
  std::uint16_t number = 0;                       ///< chosen by the host; the device repeats it in its reports
  std::array<AxisParameters, kAxisCount> axes{};  ///< what is asked of each axis
};
constexpr std::size_t kParameterReportSize = 43;  ///< bytes, its id included

/// State of the device.
///
/// | byte | type | content |
/// |---|---|---|
/// | 0 | uint8 | 3 |
/// | 1 | uint8 | kProtocolVersion |
/// | 2, 3, 4 | uint8 | firmware version: major, minor, patch |
/// | 5 | uint8 | DeviceFlag bits |
/// | 6 | uint16 | number of the parameter set in force |
/// | 8 | uint16 | number of the set refused last |
/// | 10 | uint8 | Refusal of that set |
/// | 11 | uint8 | axis that was refused |
/// | 12, 16 | float32 | value and limit that were compared |
/// | 20, 24 | uint32 | accepted and refused sets since the start |
/// | 28 | uint32 | ticks that came late (more than 10 % of the period) |
struct StatusReport {
  std::uint8_t protocol = kProtocolVersion;  ///< that the firmware speaks; a host refuses others
  std::array<std::uint8_t, 3> version{};     ///< of the firmware: major, minor, patch
  std::uint8_t flags = 0;                    ///< DeviceFlag bits, of the last tick
  std::uint16_t parameter_number = 0;        ///< of the set accepted last; 0: none yet
  std::uint16_t refused_number = 0;          ///< of the set refused last; 0: none yet
  Verdict refusal{};                         ///< of that set: why, with the numbers that were compared
  std::uint32_t accepted = 0;                ///< sets since the start
  std::uint32_t refused = 0;                 ///< sets since the start
  std::uint32_t late_ticks = 0;              ///< since the start: more than 10 % of the period late
};
constexpr std::size_t kStatusReportSize = 32;  ///< bytes, its id included

/// Configuration of one axis: byte 0 is kAxisReportId + axis, then the fields of AxisConfig in their order as float32.
struct AxisReport {
  std::uint8_t axis = 0;  ///< 0 or 1
  AxisConfig config{};    ///< of that axis
};
constexpr std::size_t kAxisReportSize = 1 + 4 * kAxisConfigFields;  ///< bytes, its id included

/// Writes a sample of a device. @return its size
std::size_t pack(const InputReport& report, std::uint8_t (&bytes)[kInputReportSize]);
/// Writes a set of parameters. @return its size
std::size_t pack(const ParameterReport& report, std::uint8_t (&bytes)[kParameterReportSize]);
/// Writes the state of a device. @return its size
std::size_t pack(const StatusReport& report, std::uint8_t (&bytes)[kStatusReportSize]);
/// Writes the configuration of an axis. @param report  with axis 0 or 1  @return its size
std::size_t pack(const AxisReport& report, std::uint8_t (&bytes)[kAxisReportSize]);

/// Reads a sample. @return false: no such report; `report` stays as it was
bool unpack(const std::uint8_t* bytes, std::size_t size, InputReport& report);
/// Reads a set of parameters, which may be invalid: see validate(). @return false: no such report
bool unpack(const std::uint8_t* bytes, std::size_t size, ParameterReport& report);
/// Reads the state of a device. @return false: no such report; `report` stays as it was
bool unpack(const std::uint8_t* bytes, std::size_t size, StatusReport& report);
/// Reads the configuration of either axis. @return false: no such report; `report` stays as it was
bool unpack(const std::uint8_t* bytes, std::size_t size, AxisReport& report);

}  // namespace vibe_firmware
