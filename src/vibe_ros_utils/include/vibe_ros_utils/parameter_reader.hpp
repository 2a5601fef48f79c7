#pragma once
#include <ros/node_handle.h>

#include <set>
#include <string>

namespace vibe::ros_utils {

/// Reads the private parameters of a node one by one, and then rejects the ones that were not read: a
/// misspelt parameter must not silently leave a default in force.
class ParameterReader {
 public:
  explicit ParameterReader(const ros::NodeHandle& handle) : handle_(handle) {}  ///< private, "~"

  /// Each leaves `value` as it is if the parameter is not set.
  /// @throws Error for a parameter of another type or out of range
  void read(const std::string& name, std::string& value);
  /// The same for true or false.
  void read(const std::string& name, bool& value);
  /// The same for a whole number. @param low, high  range, both allowed
  void read(const std::string& name, int& value, int low, int high);
  /// @param unit  for the error only
  void read(const std::string& name, double& value, double low, double high, const std::string& unit);

  /// @throws Error if the parameter is not set or empty
  std::string required(const std::string& name, const std::string& meaning);

  /// @throws Error if a private parameter is set that has not been read; call last
  void finish() const;

  /// Says in the log which private parameters are set: those of an earlier run stay at the master until somebody
  /// deletes them.
  void log() const;

 private:
  ros::NodeHandle handle_;
  std::set<std::string> known_;

  bool fetch(const std::string& name, XmlRpc::XmlRpcValue& value);
  [[noreturn]] void failType(const std::string& name, const std::string& expected) const;
};

}  // namespace vibe::ros_utils
