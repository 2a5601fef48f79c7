#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::endoscope {

/// Writes a file of NumPy (format 1.0, little endian, rows first).
/// @param shape  the product is the number of values
/// @throws std::runtime_error  it cannot be written
void writeNpy(const std::string& file, const std::vector<std::size_t>& shape, const std::vector<float>& values);
void writeNpy(const std::string& file, const std::vector<std::size_t>& shape, const std::vector<std::uint32_t>& values);
/// The same with half precision (IEEE 754 binary16: eleven bits), for unit vectors.
void writeHalfNpy(const std::string& file, const std::vector<std::size_t>& shape, const std::vector<float>& values);

}  // namespace vibe::endoscope
