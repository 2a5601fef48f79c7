#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"
#include "vibe_core/tissue/tissue_model.hpp"
#include "vibe_core/tool/scope_springs.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

class CinchModel;

/// Everything that is constant during a simulation. Can be shared between threads and any number of states.
struct Model {
  Scene scene;             ///< as the user wrote it; nothing changes it
  Organ organ;             ///< rest shape and anatomy
  int particle_count = 0;  ///< vertices of organ.surface

  // per particle, (particle_count)
  std::vector<double> mass;          ///< [kg]
  std::vector<double> inverse_mass;  ///< 0: held in place [1/kg]
  std::vector<double> area;          ///< of wall at rest [m^2]

  double particle_radius = 0;  ///< contact distance from the mid-surface: half the mean wall thickness [m]
  Eigen::Vector3d unbalanced_gravity =
      Eigen::Vector3d::Zero();  ///< gravity, 0 where the foundation carries the weight [m/s^2]
  double rest_volume = 0;       ///< of the lumen [m^3]

  std::shared_ptr<const TissueModel> tissue;  ///< elastic law of the wall
  std::shared_ptr<const Solver> solver;       ///< time stepping
  int substeps = 0;  ///< per step, of a solver that uses them: the asked number, or the fewest that are stable; else 0

  std::shared_ptr<const ToolModel> tool;                        ///< null without scope
  std::optional<ScopeSprings> scope_springs;                    ///< empty: the tool is rigid
  Eigen::Isometry3d tool_base = Eigen::Isometry3d::Identity();  ///< pose of the tool's root link in world [m]
  int tip_link = -1;     ///< scope_tip; this and the next three are link numbers in `tool`, -1 without one
  int helix_link = -1;   ///< its origin is the tip of the helix
  int grip_link = -1;    ///< carries the helix, which turns in it
  int needle_link = -1;  ///< its origin is the needle's point

  std::optional<ThermalDose> dose_law;  ///< of the argon beam; empty without scene.marking

  std::shared_ptr<const CinchModel> cinch;  ///< null: sets pull by their thread, or there is no scene.suture

  RenderSurface render_surface;  ///< empty without scene.render_surface

  /// Position of every particle along the axis of the organ at rest, 0: apex of the fundus, 1: pylorus; for an organ
  /// without these ends, along its entry axis. (particle_count), empty without scene.suture and breathingOf().
  std::vector<double> along;
};

}  // namespace vibe
