#include "geometry/assimp_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/own_place.hpp"
#include "geometry/mesh_stream.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

using Clock = std::chrono::steady_clock;

/// File and signal settings for posix_spawn().
class SpawnSetup {
 public:
  explicit SpawnSetup(int output) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;

  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

pid_t spawn(const std::filesystem::path& program, const std::vector<std::string>& arguments, int output) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const SpawnSetup setup(output);
  pid_t child = 0;
  const int failure = posix_spawn(&child, words[0].c_str(), &setup.files, &setup.attributes, pointers.data(), environ);
  if (failure != 0) throw Error(std::string("no process can be started: ") + std::strerror(failure));
  return child;
}

enum class ReadResult { Complete, TooLong, TooLarge };

/// Appends to `bytes` until the program closes its end of the pipe or a limit is reached.
ReadResult readAll(int pipe, const WorkLimits& limits, std::string& bytes) {
  const auto end = Clock::now() + std::chrono::seconds(limits.seconds);
  std::array<char, 1 << 16> part;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return ReadResult::TooLong;
    pollfd waiting{pipe, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(std::min<long>(left, 1000))) <= 0) continue;
    const ssize_t count = read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return ReadResult::Complete;
    bytes.append(part.data(), static_cast<std::size_t>(count));
    if (bytes.size() > limits.memory) return ReadResult::TooLarge;
  }
}

int waitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

std::string runHelper(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      const WorkLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(std::string("no pipe can be made: ") + std::strerror(errno));
  pid_t child = 0;
  try {
    child = spawn(program, arguments, ends[1]);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  std::string answer;
  const ReadResult reading = readAll(ends[0], limits, answer);
  close(ends[0]);
  if (reading != ReadResult::Complete) kill(child, SIGKILL);
  const int status = waitFor(child);
  if (reading == ReadResult::TooLong) throw Error("it takes more than " + std::to_string(limits.seconds) + " s");
  if (reading == ReadResult::TooLarge)
    throw Error("its surface needs more than " + std::to_string(limits.memory) + " bytes");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Error("its content stops the reader");
  return answer;
}

namespace {

constexpr char kProgram[] = "vibe_mesh_reader";
constexpr char kVariable[] = "VIBE_MESH_READER";

std::filesystem::path findReader() {
  if (const char* named = std::getenv(kVariable); named != nullptr && *named != '\0') return named;
  std::filesystem::path found = findOwnProgram(kProgram);
  if (!found.empty()) return found;
  throw Error(std::string("geometry.file: the program ") + kProgram +
              ", which reads meshes, is installed neither beside this program nor beside the library; set " +
              kVariable + " to its path.");
}

/// Larger files get more time and memory.
WorkLimits limitsFor(const std::string& path) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  const auto megabytes = none ? 0U : static_cast<unsigned>(size >> 20);
  WorkLimits limits;
  limits.seconds = 20 + megabytes / 2;
  limits.memory += std::size_t{100} * megabytes << 20;
  return limits;
}

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, ' ');
  return text;
}

}  // namespace

SurfaceMesh readWithAssimp(const std::string& path) {
  return readWithAssimp(path, limitsFor(path));
}

SurfaceMesh readWithAssimp(const std::string& path, const WorkLimits& limits) {
  const std::filesystem::path reader = findReader();
  // the time limit in the program itself applies only if this process ends first
  const std::string seconds = std::to_string(limits.seconds + 5), memory = std::to_string(limits.memory);
  try {
    return unpackMesh(runHelper(reader, {path, seconds, memory}, limits));
  } catch (const Error& e) {
    throw Error("geometry.file: " + path + " cannot be read (" + oneLine(e.what()) + "); export it again");
  }
}

}  // namespace vibe
