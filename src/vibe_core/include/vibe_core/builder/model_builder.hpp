#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/program/progress.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Builds the organ that a scene asks for: procedural, imported or a plain sphere, remeshed to exactly
/// scene.geometry.particles vertices, with regions, walls, ends and thickness per vertex. The centre of the enclosed
/// volume is the origin. The entry of a procedural stomach is the centre of the rim of the dome that closes the
/// oesophagus; that of an imported one is the surface point nearest to its oesophagus landmark, and the axis the
/// direction in which a straight scope of 6 mm radius gets farthest. A relative geometry.file is beside the scene file.
/// Deterministic. Takes up to some tens of seconds for an imported mesh; reports progress.
/// @throws Error if the surface cannot be used (file, hole, orientation, size ...).
Organ buildOrgan(const Scene& scene, const Progress& progress = {});

/// Builds the model of a scene: everything that is constant during the simulation. Deterministic.
/// @param tool_urdf  text of the URDF that scene.scope names (the library does not know packages); unused without scope
/// @throws Error
std::shared_ptr<const Model> buildModel(const Scene& scene, const std::string& tool_urdf,
                                        const Progress& progress = {});

/// The second part of buildModel(), for organs made in code: fills everything except model.scene and model.organ, which
/// the caller has set and which stay as they are.
/// @throws Error
void finishModel(const std::string& tool_urdf, Model& model, const Progress& progress = {});

/// One sentence if the substeps are too long for the requested stiffness, otherwise empty.
std::string softnessWarning(const Model& model);

/// One sentence if the scene states a gravity that does not act on the wall, because the foundation carries the weight
/// whatever its direction, otherwise empty. The default gravity needs none: the organ has its given shape under it.
std::string weightWarning(const Model& model);

/// What may not be meant in a scene: the sentences of softnessWarning(), fitWarning() and weightWarning().
std::vector<std::string> warningsAbout(const Model& model);

/// The state at time 0: rest shape, scope at the lower end of its range, gas at its initial pressure.
State initialState(const Model& model, std::uint64_t seed);

}  // namespace vibe
