#include "scene/schema_rows.hpp"
#include "vibe_core/scene/schema.hpp"

namespace vibe {
namespace {

constexpr double kTurn = 6.2832;                   // a full turn, rounded up so that "360 deg" is allowed
constexpr double kLargestSeed = 9007199254740991;  // 2^53 - 1: exact in every YAML and JSON reader
constexpr auto kStomach = GeometryScene::Kind::Stomach;
constexpr auto kMesh = GeometryScene::Kind::Mesh;
constexpr auto kSphere = GeometryScene::Kind::Sphere;
constexpr const char* kChoice = "design choice";
constexpr const char* kThickness =
    "mean of 50 specimens in \"Human tissue thickness measurements from excised sleeve gastrectomy specimens\"";

std::vector<SchemaRow> topRows() {
  return {
      {"name", [](Scene& s) -> std::string& { return s.name; }, "", 0, 0, "what to call the scene in reports", kChoice},
      {"seed", [](Scene& s) -> std::uint64_t& { return s.seed; }, "1", 0, kLargestSeed,
       "start of the random generator; equal seeds give equal sessions", kChoice},
      {"step_period", [](Scene& s) -> double& { return s.step_period; }, "s", 1e-4, 0.1, "simulated time per step",
       "one frame of a 60 Hz display"},
      {"render_surface", [](Scene& s) -> bool& { return s.render_surface; }, "", 0, 0,
       "also publish a smoother surface to draw, with four times the triangles (Loop 1987)", kChoice},
  };
}

std::vector<SchemaRow> geometryRows() {
  return {
      {"geometry.kind", [](Scene& s) -> GeometryScene::Kind& { return s.geometry.kind; }, "", 0, 0,
       "`stomach`: procedural J-shaped stomach; `mesh`: any closed surface from a file; `sphere`: for tests", kChoice},
      {"geometry.particles", [](Scene& s) -> int& { return s.geometry.particles; }, "1", 100, 200000,
       "exactly this many particles on the mid-surface of the wall", "particle count of the ViBE prototype"},
      {"geometry.volume", [](Scene& s) -> double& { return s.geometry.volume; }, "m^3", 1e-5, 1e-2,
       "enclosed volume without stress",
       "Toro 2015, Surg Laparosc Endosc Percutan Tech 25:324: capacity 0.71 +- 0.32 L, rounded", kStomach},
      {"geometry.radius", [](Scene& s) -> double& { return s.geometry.radius; }, "m", 1e-3, 1.0, "radius of the sphere",
       kChoice, kSphere},
  };
}

std::vector<SchemaRow> meshRows() {
  using Point = std::optional<Eigen::Vector3d>;
  return {
      {"geometry.file", [](Scene& s) -> std::string& { return s.geometry.file; }, "", 0, 0,
       "closed surface as OBJ, STL, PLY or glTF; relative to the scene file", "none", kMesh, "none", true},
      {"geometry.unit", [](Scene& s) -> double& { return s.geometry.unit; }, "m", 1e-6, 10,
       "length of one unit of the file, e.g. `1 mm`; may be left out for glTF (metres) or with target_volume",
       "the file", kMesh, "as the file states"},
      {"geometry.target_volume", [](Scene& s) -> double& { return s.geometry.target_volume; }, "m^3", 1e-5, 1e-2,
       "scale the surface evenly to this volume, whatever its unit", kChoice, kMesh, "size of the file"},
      {"geometry.rotation_rpy", [](Scene& s) -> std::array<double, 3>& { return s.geometry.rotation_rpy; }, "rad",
       -kTurn, kTurn, "roll, pitch, yaw about fixed axes from the file's axes to ours (x anterior, y left, z cranial)",
       kChoice, kMesh},
      {"geometry.landmarks.oesophagus", [](Scene& s) -> Point& { return s.geometry.oesophagus; }, "file units", -1e9,
       1e9, "centre of the junction with the oesophagus, in the file's axes and unit", "the user", kMesh, "none", true},
      {"geometry.landmarks.fundus", [](Scene& s) -> Point& { return s.geometry.fundus; }, "file units", -1e9, 1e9,
       "apex of the fundus", "the user", kMesh, "none", true},
      {"geometry.landmarks.incisura", [](Scene& s) -> Point& { return s.geometry.incisura; }, "file units", -1e9, 1e9,
       "angular incisure, the notch of the lesser curvature", "the user", kMesh, "none", true},
      {"geometry.landmarks.pylorus", [](Scene& s) -> Point& { return s.geometry.pylorus; }, "file units", -1e9, 1e9,
       "centre of the pyloric orifice", "the user", kMesh, "none", true},
  };
}

std::vector<SchemaRow> tissueRows() {
  return {
      {"tissue.model", [](Scene& s) -> std::string& { return s.tissue.model; }, "", 0, 0,
       "`shell`: a wall that stretches and bends, with an error that is known; `shape_matching`: the method of the "
       "ViBE prototype",
       "fastest for its error, see accuracy.md"},
      {"tissue.law", [](Scene& s) -> std::string& { return s.tissue.law; }, "", 0, 0,
       "elastic law of the shell: neo_hookean, stable_neo_hookean, macklin_mueller, fung, gent or yeoh; the last three "
       "stiffen with stretch",
       "stomach wall stiffens exponentially: Fung fits of porcine stomach, Dargar 2019, doi 10.1115/1.4043259"},
      {"tissue.stiffening", [](Scene& s) -> double& { return s.tissue.stiffening; }, "1", 0, 100,
       "exponent of fung and yeoh, 1 over the limit of gent, in units of I1 - 3 - 2 ln J",
       "design choice: soft at the pressures of gastroscopy, no bursting up to 45 mmHg"},
      {"tissue.density", [](Scene& s) -> double& { return s.tissue.density; }, "kg/m^3", 100, 5000,
       "mass per volume of the wall", "soft tissue is close to water, 1050 to 1060 kg/m^3"},
      {"tissue.young_modulus", [](Scene& s) -> double& { return s.tissue.young_modulus; }, "Pa", 100, 1e9,
       "stiffness of the wall at endoscopic distension",
       "fitted on the default stomach to a compliance of 36.1 +- 14.7 mL/mmHg at 10 mmHg (Toro 2015)"},
      {"tissue.poisson_ratio", [](Scene& s) -> double& { return s.tissue.poisson_ratio; }, "1", 0, 0.499,
       "contraction across per extension along", "nearly incompressible, design choice"},
      {"tissue.thickness.cardia", [](Scene& s) -> double& { return s.tissue.thickness[0]; }, "m", 1e-4, 2e-2,
       "wall of the cardia", "as the fundus: thinnest near the junction (Elariny 2005, Surg Technol Int 14:119)"},
      {"tissue.thickness.fundus", [](Scene& s) -> double& { return s.tissue.thickness[1]; }, "m", 1e-4, 2e-2,
       "wall of the fundus", kThickness},
      {"tissue.thickness.body", [](Scene& s) -> double& { return s.tissue.thickness[2]; }, "m", 1e-4, 2e-2,
       "wall of the body", kThickness},
      {"tissue.thickness.antrum", [](Scene& s) -> double& { return s.tissue.thickness[3]; }, "m", 1e-4, 2e-2,
       "wall of the antrum", kThickness},
      {"tissue.thickness.pylorus", [](Scene& s) -> double& { return s.tissue.thickness[4]; }, "m", 1e-4, 2e-2,
       "wall of the pylorus", "as the antrum"},
      {"tissue.stiffness.cardia", [](Scene& s) -> double& { return s.tissue.stiffness[0]; }, "1", 0.01, 100,
       "factor of young_modulus and of the fibres' modulus in the cardia", kChoice},
      {"tissue.stiffness.fundus", [](Scene& s) -> double& { return s.tissue.stiffness[1]; }, "1", 0.01, 100,
       "factor of young_modulus and of the fibres' modulus in the fundus", kChoice},
      {"tissue.stiffness.body", [](Scene& s) -> double& { return s.tissue.stiffness[2]; }, "1", 0.01, 100,
       "factor of young_modulus and of the fibres' modulus in the body", kChoice},
      {"tissue.stiffness.antrum", [](Scene& s) -> double& { return s.tissue.stiffness[3]; }, "1", 0.01, 100,
       "factor of young_modulus and of the fibres' modulus in the antrum", kChoice},
      {"tissue.stiffness.pylorus", [](Scene& s) -> double& { return s.tissue.stiffness[4]; }, "1", 0.01, 100,
       "factor of young_modulus and of the fibres' modulus in the pylorus", kChoice},
      {"tissue.fibres.modulus", [](Scene& s) -> double& { return s.tissue.fibres->modulus; }, "Pa", 0, 1e9,
       "stiffness of each of the two families; along both at once, 8 times this adds to young_modulus",
       "with the angle 0 the wall is 1.7 times as stiff along the organ as around it, as porcine corpus: Fournier "
       "2024, "
       "doi 10.1016/j.jmbbm.2024.106712"},
      {"tissue.fibres.stiffening", [](Scene& s) -> double& { return s.tissue.fibres->stiffening; }, "1", 0.01, 100,
       "exponent of their energy, by the square of their squared stretch less 1", kChoice},
      {"tissue.fibres.angle", [](Scene& s) -> double& { return s.tissue.fibres->angle; }, "rad", 0, 1.5708,
       "of the families to each side of the organ's long axis; 0 along it, a right angle around it", kChoice},
      {"tissue.mass_damping", [](Scene& s) -> double& { return s.tissue.mass_damping; }, "1/s", 0, 1e4,
       "viscous damping of the velocity: free motion falls to 1/e in one over this", kChoice},
      {"tissue.stiffness_damping", [](Scene& s) -> double& { return s.tissue.stiffness_damping; }, "s", 0, 1e-3,
       "viscosity of the wall over its stiffness; quiets the shortest waves and is not felt by the long ones", kChoice},
      {"tissue.iterations", [](Scene& s) -> int& { return s.tissue.iterations; }, "1", 1, 100,
       "iterations of a step of the shell: fewer when nothing moves any more, up to 12 while they do not converge; "
       "even numbers are steadier, 1 is for steps of a millisecond",
       kChoice},
      {"tissue.spectral_radius", [](Scene& s) -> double& { return s.tissue.spectral_radius; }, "1", 0, 1,
       "part of the fastest vibrations that a step of the shell keeps; 1 conserves energy, 0 quiets at once",
       "generalised-alpha: Chung, Hulbert 1993, doi 10.1115/1.2900803"},
      {"tissue.self_contact", [](Scene& s) -> bool& { return s.tissue.self_contact; }, "", 0, 0,
       "walls of the shell that are pulled together meet and do not pass through each other", kChoice},
      {"tissue.substeps", [](Scene& s) -> int& { return s.tissue.substeps; }, "1", 0, 1000,
       "sub-steps per step of shape_matching; 0: as few as carry the stiffness",
       "many small steps with one iteration each: Macklin 2019, doi 10.1145/3309486.3340247"},
  };
}

std::vector<SchemaRow> environmentRows() {
  return {
      {"attachments.oesophagus", [](Scene& s) -> bool& { return s.attach_oesophagus; }, "", 0, 0,
       "hold the particles of the end at the oesophagus in place", kChoice},
      {"attachments.duodenum", [](Scene& s) -> bool& { return s.attach_duodenum; }, "", 0, 0,
       "hold the particles of the end at the duodenum in place", kChoice},
      {"gas.initial_pressure", [](Scene& s) -> double& { return s.gas->initial_pressure; }, "Pa", -5e3, 2e4,
       "gauge pressure at the start", kChoice},
      {"gas.regulated_pressure", [](Scene& s) -> double& { return s.gas->regulated_pressure; }, "Pa", 0, 2e4,
       "gauge pressure at which the insufflator stops",
       "Ushimaru 2020, Sci Rep 10:18169: 10.0 mmHg during gastroscopy in 80 patients"},
      {"gas.flow_limit", [](Scene& s) -> double& { return s.gas->flow_limit; }, "m^3/s", 0, 1e-2,
       "largest flow of the insufflator, counted at ambient pressure", "3 L/min, design choice"},
      {"gas.insufflator_on", [](Scene& s) -> bool& { return s.gas->insufflator_on; }, "", 0, 0,
       "whether the insufflator runs from the start", kChoice},
      {"gravity.acceleration", [](Scene& s) -> Eigen::Vector3d& { return s.gravity->acceleration; }, "m/s^2", -100, 100,
       "direction and size; x is anterior, so the default is a patient on the back", "standard gravity, rounded"},
      {"foundation.stiffness", [](Scene& s) -> double& { return s.foundation->stiffness; }, "Pa/m", 0, 1e7,
       "stiffness of the neighbouring organs per area of wall", kChoice},
      {"foundation.carries_weight", [](Scene& s) -> bool& { return s.foundation->carries_weight; }, "", 0, 0,
       "the foundation balances the weight, so that the given shape is the shape in place", kChoice},
  };
}

std::vector<SchemaRow> toolRows() {
  return {
      {"scope.urdf", [](Scene& s) -> std::string& { return s.scope->urdf; }, "", 0, 0,
       "endoscope and suturing device: `package://` or a path relative to the scene file", kChoice},
      {"scope.friction", [](Scene& s) -> double& { return s.scope->friction; }, "1", 0, 2,
       "Coulomb friction of the tool on the mucosa", kChoice},
      {"scope.base.position", [](Scene& s) -> Eigen::Vector3d& { return s.scope->base_position; }, "m", -10, 10,
       "origin of `scope_base` in `world`", "none", std::nullopt, "none", true},
      {"scope.base.rpy", [](Scene& s) -> std::array<double, 3>& { return s.scope->base_rpy; }, "rad", -kTurn, kTurn,
       "roll, pitch, yaw of `scope_base` about the fixed axes of `world`; its x axis points into the lumen", kChoice},
  };
}

}  // namespace

const std::vector<SchemaRow>& sceneSchema() {
  static const std::vector<SchemaRow> rows = [] {
    std::vector<SchemaRow> all;
    for (auto* group : {topRows, geometryRows, meshRows, tissueRows, environmentRows, toolRows, procedureRows}) {
      for (const SchemaRow& row : group()) all.push_back(row);
    }
    return all;
  }();
  return rows;
}

}  // namespace vibe
