#pragma once
#include <string>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The bytes of a snapshot, as saveSnapshot() writes them.
std::string encodeSnapshot(const Model& model, const State& state);

/// Whether a state may be taken from a scene with other values: of tissue, gas, friction, and so on. Its organ at rest,
/// its step and the parts that there are must be the same in any case.
enum class OtherScene { Refused, Taken };

/// The state of such bytes.
/// @param place  where they come from, for messages
/// @throws Error, as loadSnapshot()
State decodeSnapshot(const Model& model, const std::string& bytes, const std::string& place,
                     OtherScene other = OtherScene::Refused);

/// What a state must agree with to be continued with a model: rest shape, masses, step, and which parts there are.
std::uint64_t modelFingerprint(const Model& model);

/// All other values on which the future of a state depends: every key of the scene but its name, its seed, files and
/// what is only drawn, with the limits of the tool's joints.
std::uint64_t sceneFingerprint(const Model& model);

/// Writes a state to a file: a header with the version, the list of the state's fields (state_fields.hpp) and the
/// fingerprints of model and scene, then the bits of all fields. The file appears whole or not at all.
/// @throws Error if the file cannot be written
void saveSnapshot(const Model& model, const State& state, const std::string& file);

/// Reads what saveSnapshot() wrote; the returned state has the same hash.
/// @throws Error if the file is missing, truncated, of another version, or of another model or scene, or if it holds a
/// state that no session of the model can have reached
State loadSnapshot(const Model& model, const std::string& file, OtherScene other = OtherScene::Refused);

}  // namespace vibe
