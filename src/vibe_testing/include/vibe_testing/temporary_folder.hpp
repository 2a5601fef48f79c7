#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace vibe::test {

/// A folder for the files of a test, removed with it.
class TemporaryFolder {
 public:
  /// @throws std::runtime_error if it cannot be made
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "vibe_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Writes the file; returns its path.
  std::string write(const std::string& name, const std::string& content) const {
    const std::string path = path_ + "/" + name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  const std::string& path() const { return path_; }  ///< without a slash at the end

 private:
  std::string path_;
};

}  // namespace vibe::test
