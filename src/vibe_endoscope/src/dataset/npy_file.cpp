#include "dataset/npy_file.hpp"

#include <Eigen/Core>
#include <fstream>
#include <stdexcept>

namespace vibe::endoscope {
namespace {

constexpr std::size_t kAlign = 64;  // of the data, as the format asks for

/// @param type  as NumPy writes it, "<f4"
void writeArray(const std::string& file, const std::vector<std::size_t>& shape, const std::string& type,
                const void* values, std::size_t bytes) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
  for (const std::size_t length : shape) header += std::to_string(length) + ", ";
  header += "), }";
  constexpr std::size_t kPrefix = 10;
  header.resize((kPrefix + header.size() + kAlign) / kAlign * kAlign - kPrefix, ' ');
  header.back() = '\n';
  std::ofstream out(file, std::ios::binary);  // not whole: the folder of the data set is
  out.write("\x93NUMPY\x01\x00", 8);
  out.put(static_cast<char>(header.size() & 0xff)).put(static_cast<char>(header.size() >> 8));
  out.write(header.data(), static_cast<std::streamsize>(header.size()));
  out.write(static_cast<const char*>(values), static_cast<std::streamsize>(bytes));
  out.close();
  if (!out)
    throw std::runtime_error("'" + file +
                             "' cannot be written; make room if the disk is full, or choose another folder.");
}

}  // namespace

void writeNpy(const std::string& file, const std::vector<std::size_t>& shape, const std::vector<float>& values) {
  writeArray(file, shape, "<f4", values.data(), values.size() * sizeof values[0]);
}

void writeNpy(const std::string& file, const std::vector<std::size_t>& shape,
              const std::vector<std::uint32_t>& values) {
  writeArray(file, shape, "<u4", values.data(), values.size() * sizeof values[0]);
}

void writeHalfNpy(const std::string& file, const std::vector<std::size_t>& shape, const std::vector<float>& values) {
  std::vector<Eigen::half> halves;
  halves.reserve(values.size());
  for (const float value : values) halves.emplace_back(value);
  writeArray(file, shape, "<f2", halves.data(), halves.size() * sizeof halves[0]);
}

}  // namespace vibe::endoscope
