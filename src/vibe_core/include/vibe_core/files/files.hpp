#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace vibe {

/// Resolves an address to a file path. "package://NAME/FILE" is looked up in this order: 1. in the folders of the
/// environment variable ROS_PACKAGE_PATH (folders of packages, or a package itself), 2. in PREFIX/share/NAME of each
/// prefix in the environment variable CMAKE_PREFIX_PATH, 3. in PREFIX/share/NAME of the prefix under which the running
/// program or this library is installed, 4. below the folders of ROS_PACKAGE_PATH, to a depth of five, for a
/// package.xml with this name. A folder is a package if it contains a package.xml. Any other address is returned as a
/// path. Does not need ROS.
/// @throws Error if no folder contains such a package
std::string resolveAddress(const std::string& address);

/// Reads a text file as a whole.
/// @param what  name used in the error message, e.g. "URDF"
/// @throws Error if it cannot be read
std::string readTextFile(const std::string& file, const std::string& what);

/// A file that is there whole or not at all, also after a power cut, a full disk or kill -9: .part-FILE beside it,
/// which is written to, takes its place once it is complete and on the disk. What is not an ordinary file, such as
/// /dev/stdout, is written directly. After kill -9 the .part-FILE is left, and the next writer of FILE begins it anew.
class WholeFile {
 public:
  /// @param what  name used in error messages, e.g. "Snapshot"
  WholeFile(std::string file, std::string what);
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  ~WholeFile();  ///< without finish(), what was there before is there still, and no .part-FILE is left

  const std::string& part() const { return part_; }  ///< the path to write to
  /// Puts the file in place. @param written  whether all of it was written and closed
  /// @throws Error if it was not, or cannot be
  void finish(bool written);

 private:
  std::string file_, what_;
  std::filesystem::path target_;  // a link stays a link
  std::string part_;
  bool is_special_ = false, is_finished_ = false;
};

/// Writes a whole file by a function that is given the path to write to, and returns whether it could.
/// @throws Error as WholeFile
void writeWhole(const std::string& file, const std::function<bool(const std::string& part)>& write,
                const std::string& what);

/// The same of a text. @throws Error as WholeFile
void writeFile(const std::string& file, const std::string& content, const std::string& what);

}  // namespace vibe
