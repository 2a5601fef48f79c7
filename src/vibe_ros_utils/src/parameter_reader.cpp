#include "vibe_ros_utils/parameter_reader.hpp"

#include <ros/console.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::ros_utils {

using XmlRpc::XmlRpcValue;

bool ParameterReader::fetch(const std::string& name, XmlRpcValue& value) {
  known_.insert(name);
  return handle_.getParam(name, value);
}

void ParameterReader::failType(const std::string& name, const std::string& expected) const {
  throw Error("Parameter " + handle_.resolveName(name) + " must be " + expected + ".");
}

void ParameterReader::read(const std::string& name, std::string& value) {
  XmlRpcValue given;
  if (!fetch(name, given)) return;
  if (given.getType() != XmlRpcValue::TypeString) failType(name, "a text");
  value = static_cast<std::string>(given);
}

void ParameterReader::read(const std::string& name, bool& value) {
  XmlRpcValue given;
  if (!fetch(name, given)) return;
  if (given.getType() != XmlRpcValue::TypeBoolean) failType(name, "true or false");
  value = static_cast<bool>(given);
}

void ParameterReader::read(const std::string& name, int& value, int low, int high) {
  XmlRpcValue given;
  if (!fetch(name, given)) return;
  const std::string expected = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  if (given.getType() != XmlRpcValue::TypeInt) failType(name, expected);
  const int number = given;
  if (number < low || number > high) failType(name, expected);
  value = number;
}

void ParameterReader::read(const std::string& name, double& value, double low, double high, const std::string& unit) {
  XmlRpcValue given;
  if (!fetch(name, given)) return;
  const std::string expected = "a number from " + showQuantity(low, unit) + " to " + showQuantity(high, unit);
  if (given.getType() != XmlRpcValue::TypeDouble && given.getType() != XmlRpcValue::TypeInt) failType(name, expected);
  // rosparam stores "5" as an integer, which is valid as a number of seconds
  const double number = given.getType() == XmlRpcValue::TypeInt ? static_cast<int>(given) : static_cast<double>(given);
  if (!(number >= low && number <= high)) failType(name, expected);
  value = number;
}

std::string ParameterReader::required(const std::string& name, const std::string& meaning) {
  std::string value;
  read(name, value);
  if (value.empty()) throw Error("Parameter " + handle_.resolveName(name) + " is not set; set it to " + meaning + ".");
  return value;
}

void ParameterReader::finish() const {
  XmlRpcValue all;
  if (!handle_.getParam(handle_.getNamespace(), all) || all.getType() != XmlRpcValue::TypeStruct) return;
  for (const auto& [name, value] : all) {
    if (known_.count(name)) continue;
    const std::string remedy = suggestKey(name, std::vector<std::string>(known_.begin(), known_.end()));
    throw Error("There is no parameter " + handle_.resolveName(name) + "; " + remedy +
                (remedy.back() == '?' ? "" : ".") + " Remove it with `rosparam delete " + handle_.resolveName(name) +
                "`.");
  }
}

void ParameterReader::log() const {
  XmlRpcValue all;
  if (!handle_.getParam(handle_.getNamespace(), all) || all.getType() != XmlRpcValue::TypeStruct) return;
  std::ostringstream given;
  for (const auto& [name, value] : all) given << (given.tellp() > 0 ? ", " : "") << name << " = " << value;
  ROS_INFO_STREAM("Parameters in " << handle_.getNamespace() << ": " << given.str() << ".");
}

}  // namespace vibe::ros_utils
