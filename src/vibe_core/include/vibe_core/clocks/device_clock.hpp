#pragma once
#include <cstdint>
#include <deque>

namespace vibe {

/// Maps the time of a device to that of the host from pairs of both. A report arrives some time after its sample, never
/// before, and sometimes with hardly any delay: the map is a line below all pairs of the last two minutes (Moon,
/// Skelly, Towsley, "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999), so that
/// jitter of USB and scheduling disappears and drift is followed. What remains is the smallest delay of the link, and
/// in the first two minutes a part of the period at which the bus is polled.
class DeviceClock {
 public:
  /// Adds a pair. @param device  unwrapped [s]  @param arrival  of the report, host [s]
  void add(double device, double arrival);
  void clear();

  bool empty() const { return minima_.empty(); }
  double hostTime(double device) const;    ///< [s]
  double deviceTime(double host) const;    ///< [s]
  double drift() const { return slope_; }  ///< seconds that the host's clock gains per second of the device's

 private:
  struct Pair {
    double device, delay;  // delay: arrival - device
  };

  std::deque<Pair> minima_;  // the smallest delay of each second
  double anchor_ = 0;        // device time at which the line is offset_
  double offset_ = 0;
  double slope_ = 0;
  double late_since_ = -1;  // arrival since which every report is late by the same; -1: none is
  double late_delay_ = 0;   // of the report at late_since_

  void keep(const Pair& pair);
  void fit();
  bool hasStepped(const Pair& pair, double arrival);
};

}  // namespace vibe
