#pragma once

namespace vibe {

/// Loads the libraries that the environment variable VIBE_PLUGINS names, separated by ':', once per process: what they
/// register when they are loaded is known from then on. A name without a folder is looked for beside this library, then
/// where the loader looks. Scenes are read after it.
/// @throws Error for a library that cannot be loaded
void loadPlugins();

}  // namespace vibe
