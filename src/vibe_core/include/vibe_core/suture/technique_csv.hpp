#pragma once
#include <Eigen/Core>
#include <istream>
#include <string>
#include <vector>

namespace vibe {

/// Reads suture sets from a text file with one row `x,y,z` per bite, in any unit of length, and a blank line between
/// sets. '#' begins a comment, also after a row. A line with only a comment does not end a set. The first row may be a
/// header; its names x, y and z then select the columns, and other columns are ignored.
/// @param name  of the file, for messages
/// @throws vibe::Error  `name:line` and the reason: too few or too many columns, a value that is not a finite number, a
///         header without x, y or z, no bite at all, or a read error
std::vector<std::vector<Eigen::Vector3d>> readTechniqueCsv(std::istream& in, const std::string& name);

}  // namespace vibe
