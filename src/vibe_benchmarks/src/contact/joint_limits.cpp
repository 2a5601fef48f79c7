#include "contact/joint_limits.hpp"

#include <cstdio>

#include "vibe_core/common/error.hpp"

namespace vibe::benchmarks {
namespace {

void setAttribute(const std::string& name, double value, std::size_t from, std::size_t to, std::string& text) {
  const std::string opening = name + "=\"";
  const std::size_t begin = text.find(opening, from) + opening.size();
  const std::size_t end = text.find('"', begin);
  if (begin < from || end > to) throw Error("A <limit> of the URDF has no attribute " + name + "; add it.");
  char number[40];
  std::snprintf(number, sizeof number, "%.17g", value);
  text.replace(begin, end - begin, number);
}

}  // namespace

std::string withJointLimits(std::string urdf, const std::string& joint, const JointLimits& limits) {
  const std::size_t at = urdf.find("<joint name=\"" + joint + "\"");
  const std::size_t closing = at == std::string::npos ? at : urdf.find("</joint>", at);
  const std::size_t limit = at == std::string::npos ? at : urdf.find("<limit", at);
  if (closing == std::string::npos || limit == std::string::npos || limit > closing)
    throw Error("The URDF has no joint '" + joint + "' with a limit; the hard cases need it.");
  const auto end = [&] { return urdf.find('>', limit); };
  setAttribute("lower", limits.lower, limit, end(), urdf);
  setAttribute("upper", limits.upper, limit, end(), urdf);
  setAttribute("velocity", limits.velocity, limit, end(), urdf);
  return urdf;
}

}  // namespace vibe::benchmarks
