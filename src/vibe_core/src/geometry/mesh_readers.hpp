#pragma once
#include <functional>
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

// Readers of the formats of surfaces, by their standards. Each takes the content of a file and gives its triangles in
// the unit and axes of the file; polygons are cut (cutPolygon()), points and lines have none. Content is never trusted:
// sizes and numbers are checked before use, and memory is bounded by a multiple of the size of the content.
// All throw Error, as a clause with place and remedy that follows the name of the file, for content that the standard
// does not allow or that is not supported; the latter is called by its name in the standard.

/// Wavefront OBJ (Wavefront, Advanced Visualizer manual, appendix B1): polygons. Weights of vertices belong to curves
/// and surfaces and are not used. Not supported: free-form surfaces, `call` and `csh`.
SurfaceMesh readObj(const std::string& content);

/// STL (3D Systems, StereoLithography Interface Specification, 1988), as text or binary; with any number of solids.
SurfaceMesh readStl(const std::string& content);

/// PLY 1.0 (Turk 1994, The PLY polygon file format): elements `vertex`, `face` and `tristrips`, others are skipped.
SurfaceMesh readPly(const std::string& content);

/// glTF 2.0 (Khronos 2021), as JSON or GLB: the scene to be shown, with the transforms of its nodes and the default
/// weights of its morph targets; extension KHR_mesh_quantization. Not supported: skins and, where they are required,
/// extensions that concern geometry.
/// @param file  gives the content of a file that the content names relative to itself, or throws Error as a clause
SurfaceMesh readGltf(const std::string& content, const std::function<std::string(const std::string&)>& file);

}  // namespace vibe
