#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Resource limits of a helper program.
struct WorkLimits {
  unsigned seconds = 30;                      ///< of wall time [s]
  std::size_t memory = std::size_t{4} << 30;  ///< of address space, and of its output [bytes]
};

/// Runs a helper program and returns its standard output. The program is spawned, not forked, so a caller with threads
/// may do this at any time. It gets no standard input, no open files of the caller and default signal handlers. Its
/// standard error is discarded. The time limit is enforced here; the program itself enforces the memory limit.
/// @throws Error, as a clause without a full stop, if the program cannot be started, takes too long, writes too much or
///         does not exit normally with status 0
std::string runHelper(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      const WorkLimits& limits);

/// Reads all triangles of a mesh file with the Open Asset Import Library, in the unit and axes of the file, with its
/// node transforms applied. Polygons become triangle fans. The program vibe_mesh_reader does this in a separate
/// process, because damaged files can crash that library. The program is found beside the running program or beside
/// this library, or through the environment variable VIBE_MESH_READER.
/// @throws Error if the file cannot be read or the program is missing.
SurfaceMesh readWithAssimp(const std::string& path);

/// The same with given limits instead of those derived from the size of the file.
SurfaceMesh readWithAssimp(const std::string& path, const WorkLimits& limits);

}  // namespace vibe
