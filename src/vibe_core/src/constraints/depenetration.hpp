#pragma once

namespace vibe {

/// Largest speed at which a particle that is found inside the tool is pushed out. Design choice: the usual 2 to 3 mm of
/// overlap are gone within 0.03 s, and the push adds little kinetic energy [m/s].
constexpr double kDepenetrationSpeed = 0.1;

}  // namespace vibe
