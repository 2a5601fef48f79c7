#pragma once
#include <Eigen/Core>
#include <istream>
#include <string>
#include <vector>

namespace vibe {

/// Suture sets of a text file: a row `x,y,z` per bite in any unit of length, a blank line between sets. '#' begins a
/// comment, also behind a row; a line of comment only does not end a set. The first row may be a header instead; if it
/// is, its names x, y and z say which columns are read and other columns are not looked at.
/// @param name  of the file, for messages
/// @throws vibe::Error  `name:line` and what is wrong there: too few or too many columns, something that is not a
///                      finite number, a header without x, y or z; or no bite at all, or reading failed
std::vector<std::vector<Eigen::Vector3d>> readTechniqueCsv(std::istream& in, const std::string& name);

}  // namespace vibe
