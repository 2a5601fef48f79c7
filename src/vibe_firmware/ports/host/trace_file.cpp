#include "trace_file.hpp"

#include <cstring>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

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

}  // namespace vibe_firmware
