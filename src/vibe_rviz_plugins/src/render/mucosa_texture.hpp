#pragma once
#include <string>

namespace vibe::rviz_plugins {

/// Makes the solid texture that the shader of the mucosa reads (geometry/mucosa_pattern.hpp), once per process.
/// @return  its name in the resource group of this package
/// @throws std::runtime_error  the graphics system has no solid textures
const std::string& provideMucosaTexture();

}  // namespace vibe::rviz_plugins
