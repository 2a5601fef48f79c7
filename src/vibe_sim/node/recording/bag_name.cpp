#include "recording/bag_name.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

enum class Claim { Made, Taken };

// What is no regular file, such as a link to a device, is not somebody's recording.
Claim tryToClaim(const std::string& file) {
  const std::string active = file + ".active";
  if (std::filesystem::exists(file)) return Claim::Taken;
  const int descriptor =
      ::open(active.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);  // not whole: an empty mark
  if (descriptor < 0 && errno == EEXIST) return std::filesystem::is_regular_file(active) ? Claim::Taken : Claim::Made;
  if (descriptor < 0)
    throw Error("Recording '" + file + "' cannot be written (" + std::strerror(errno) +
                "); give a path in a folder that is there and that you may write to.");
  ::close(descriptor);
  if (!std::filesystem::exists(file)) return Claim::Made;
  ::unlink(active.c_str());  // its name was taken in this moment
  return Claim::Taken;
}

}  // namespace

void claimBag(const std::string& file) {
  if (tryToClaim(file) == Claim::Made) return;
  if (std::filesystem::exists(file)) throw Error("'" + file + "' is there already; give another path.");
  throw Error("Recording '" + file +
              ".active' is there already: another program writes it, or one was killed while it " +
              "did; give another path, or, if nothing writes it, keep it with `rosbag reindex` and rename it.");
}

std::string claimFreeBag(const std::string& file) {
  const std::filesystem::path path(file);
  for (int number = 1;; ++number) {
    const std::string suffix = number == 1 ? "" : "-" + std::to_string(number);
    const std::string name =
        (path.parent_path() / (path.stem().string() + suffix + path.extension().string())).string();
    if (tryToClaim(name) == Claim::Made) return name;
  }
}

void finishBag(const std::string& file) {
  const std::string active = file + ".active";
  const int descriptor = ::open(active.c_str(), O_RDONLY | O_CLOEXEC);
  ::fsync(descriptor);  // from memory to the disk, before it has its name
  ::close(descriptor);
  // a link fails where the name is taken; some file systems have none
  if (::link(active.c_str(), file.c_str()) == 0) {
    ::unlink(active.c_str());
    return;
  }
  const int why = errno;
  if (why != EEXIST && !std::filesystem::exists(file) && std::rename(active.c_str(), file.c_str()) == 0) return;
  throw Error("Recording '" + active + "' cannot be renamed to '" + file + "' (" + std::strerror(why) +
              "); rename it by hand.");
}

}  // namespace vibe::sim
