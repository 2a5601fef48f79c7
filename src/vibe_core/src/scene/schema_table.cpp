#include "scene/scene_keys.hpp"
#include "vibe_core/scene/schema.hpp"

namespace vibe {
namespace {

constexpr double kTurn = 6.2832;                   // a full turn, rounded up so that "360 deg" is allowed
constexpr double kLargestSeed = 9007199254740991;  // 2^53 - 1: exact in every YAML and JSON reader
constexpr auto kStomach = GeometryScene::Kind::Stomach;
constexpr auto kMesh = GeometryScene::Kind::Mesh;
constexpr auto kSphere = GeometryScene::Kind::Sphere;
constexpr const char* kFlexural =
    "\"Flexural and torsional rigidity of colonoscopes at room and body temperatures\": 260 to 400 N cm^2 along an "
    "Olympus CF-140S at 24 degrees Celsius, 17 % less at 37; the middle";
constexpr const char* kTorsional = "the same: 76 N cm^2 per degree at 24 degrees Celsius, 7 % less at 37";
constexpr const char* kThickness =
    "mean of 50 specimens in \"Human tissue thickness measurements from excised sleeve gastrectomy specimens\"";

constexpr const char* kRelaxation =
    "fitted to porcine oesophagus, for lack of gastric figures: stress falls by 20 to 30 % in 10 s and stabilises at "
    "about 50 % at 300 s (Yang 2006, doi 10.1115/1.2372473)";

std::vector<SchemaRow> topRows() {
  return {
      {"name", [](Scene& s) -> std::string& { return s.name; }, "", 0, 0, "name of the scene in reports", kChoice},
      {"seed", [](Scene& s) -> std::uint64_t& { return s.seed; }, "1", 0, kLargestSeed,
       "seed of the random generator; equal seeds give equal sessions", kChoice},
      {"step_period", [](Scene& s) -> double& { return s.step_period; }, "s", 1e-4, 0.1, "simulated time per step",
       "one frame of a 60 Hz display"},
      {"render_surface", [](Scene& s) -> bool& { return s.render_surface; }, "", 0, 0,
       "also publish a smoother surface for display, with four times the triangles (Loop 1987)", kChoice},
  };
}

std::vector<SchemaRow> geometryRows() {
  return {
      {"geometry.kind", [](Scene& s) -> GeometryScene::Kind& { return s.geometry.kind; }, "", 0, 0,
       "`stomach`: procedural stomach; `mesh`: any closed surface from a file; `sphere`: for tests", kChoice},
      {"geometry.particles", [](Scene& s) -> int& { return s.geometry.particles; }, "1", 100, 200000,
       "number of particles on the mid-surface of the wall; met exactly", "particle count of the ViBE prototype"},
      {"geometry.scale", [](Scene& s) -> double& { return s.geometry.scale; }, "1", 0.5, 2,
       "factor on all lengths of the organ; the wall keeps its thickness, and oesophagus and duodenum of a procedural "
       "stomach their width",
       kChoice},
      {"geometry.shape",
       [](Scene& s) -> std::string& { return s.geometry.shape; },
       "",
       0,
       0,
       "`j`: long and vertical with a deep bend; `steer_horn`: transverse, tapers without an angle to the pylorus, its "
       "lowest part; `sthenic`: between them. The types of radiology, which go with the physique: Burdan 2012, Surg "
       "Radiol Anat 34:171",
       kChoice,
       kStomach,
       nullptr,
       false,
       {"sthenic", "j", "steer_horn"}},
      {"geometry.fundus_width", [](Scene& s) -> double& { return s.geometry.fundus_width; }, "1", 0.9, 1.25,
       "factor on the width of the fundus at its apex, falling to 1 in the body; the volume stays", kChoice, kStomach},
      {"geometry.antrum_angle", [](Scene& s) -> double& { return s.geometry.antrum_angle; }, "rad", -0.4363, 0.4363,
       "angle by which the antrum turns about the incisura: above 0 the bend is sharper and the pylorus higher",
       kChoice, kStomach},
      {"geometry.volume", [](Scene& s) -> double& { return s.geometry.volume; }, "m^3", 1e-5, 1e-2,
       "enclosed volume at rest, without stress and before `scale`",
       "Toro 2015, Surg Laparosc Endosc Percutan Tech 25:324: capacity 0.71 +- 0.32 L, rounded", kStomach},
      {"geometry.radius", [](Scene& s) -> double& { return s.geometry.radius; }, "m", 1e-3, 1.0, "radius of the sphere",
       kChoice, kSphere},
  };
}

std::vector<SchemaRow> meshRows() {
  using Point = std::optional<Eigen::Vector3d>;
  return {
      {"geometry.file", [](Scene& s) -> std::string& { return s.geometry.file; }, "", 0, 0,
       "closed surface in OBJ, STL, PLY or glTF format; path relative to the scene file", "none", kMesh, "none", true},
      {"geometry.unit", [](Scene& s) -> double& { return s.geometry.unit; }, "m", 1e-6, 10,
       "length of one unit of the file, for example `1 mm`; may be left out for glTF (metres) or with target_volume",
       "the file", kMesh, "as the file states"},
      {"geometry.target_volume", [](Scene& s) -> double& { return s.geometry.target_volume; }, "m^3", 1e-5, 1e-2,
       "scale the surface uniformly to this volume, whatever its unit", kChoice, kMesh, "size of the file"},
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
       "how the wall is modelled; see the table below", "fastest for its error, see accuracy.md"},
      {"tissue.law", [](Scene& s) -> std::string& { return s.tissue.law; }, "", 0, 0,
       "elastic law of the wall, of model shell: energy per volume at rest, see the table below. There I = tr(F^T F), "
       "J = det F, K = I - 3 - 2 ln J, b is the stiffening, and mu and lambda are the Lame constants",
       "stomach wall stiffens exponentially: Fung fits of porcine stomach, Dargar 2019, doi 10.1115/1.4043259"},
      {"tissue.stiffening", [](Scene& s) -> double& { return s.tissue.stiffening; }, "1", 0, 100,
       "b of the laws fung, gent and yeoh, see the table below",
       "design choice: compliant at the pressures of gastroscopy, no bursting up to 45 mmHg"},
      {"tissue.density", [](Scene& s) -> double& { return s.tissue.density; }, "kg/m^3", 100, 5000,
       "density of the wall", "soft tissue is close to water, 1050 to 1060 kg/m^3"},
      {"tissue.young_modulus", [](Scene& s) -> double& { return s.tissue.young_modulus; }, "Pa", 100, 1e9,
       "Young's modulus of the wall at small strain",
       "fitted on the default stomach to a compliance of 36.1 +- 14.7 mL/mmHg at 10 mmHg (Toro 2015)"},
      {"tissue.poisson_ratio", [](Scene& s) -> double& { return s.tissue.poisson_ratio; }, "1", 0, 0.499,
       "Poisson's ratio of the wall", "nearly incompressible, design choice"},
      {"tissue.thickness.cardia", [](Scene& s) -> double& { return s.tissue.thickness[0]; }, "m", 1e-4, 2e-2,
       "wall thickness in the cardia",
       "same as the fundus: thinnest near the junction (Elariny 2005, Surg Technol Int 14:119)"},
      {"tissue.thickness.fundus", [](Scene& s) -> double& { return s.tissue.thickness[1]; }, "m", 1e-4, 2e-2,
       "wall thickness in the fundus", kThickness},
      {"tissue.thickness.body", [](Scene& s) -> double& { return s.tissue.thickness[2]; }, "m", 1e-4, 2e-2,
       "wall thickness in the body", kThickness},
      {"tissue.thickness.antrum", [](Scene& s) -> double& { return s.tissue.thickness[3]; }, "m", 1e-4, 2e-2,
       "wall thickness in the antrum", kThickness},
      {"tissue.thickness.pylorus", [](Scene& s) -> double& { return s.tissue.thickness[4]; }, "m", 1e-4, 2e-2,
       "wall thickness in the pylorus", "same as the antrum"},
      {"tissue.stiffness.cardia", [](Scene& s) -> double& { return s.tissue.stiffness[0]; }, "1", 0.01, 100,
       "factor on young_modulus and on the modulus of the fibres in the cardia", kChoice},
      {"tissue.stiffness.fundus", [](Scene& s) -> double& { return s.tissue.stiffness[1]; }, "1", 0.01, 100,
       "factor on young_modulus and on the modulus of the fibres in the fundus", kChoice},
      {"tissue.stiffness.body", [](Scene& s) -> double& { return s.tissue.stiffness[2]; }, "1", 0.01, 100,
       "factor on young_modulus and on the modulus of the fibres in the body", kChoice},
      {"tissue.stiffness.antrum", [](Scene& s) -> double& { return s.tissue.stiffness[3]; }, "1", 0.01, 100,
       "factor on young_modulus and on the modulus of the fibres in the antrum", kChoice},
      {"tissue.stiffness.pylorus", [](Scene& s) -> double& { return s.tissue.stiffness[4]; }, "1", 0.01, 100,
       "factor on young_modulus and on the modulus of the fibres in the pylorus", kChoice},
      {"tissue.fibres.modulus", [](Scene& s) -> double& { return s.tissue.fibres->modulus; }, "Pa", 0, 1e9,
       "modulus of each of the two fibre families; along a direction that both have, they add 8 times this to "
       "young_modulus",
       "with angle 0 the wall is 1.7 times as stiff along the organ as around it, like porcine corpus: Fournier 2024, "
       "doi 10.1016/j.jmbbm.2024.106712"},
      {"tissue.fibres.stiffening", [](Scene& s) -> double& { return s.tissue.fibres->stiffening; }, "1", 0.01, 100,
       "exponent b of the fibre energy, which is proportional to exp(b (squared stretch - 1)^2)", kChoice},
      {"tissue.fibres.angle", [](Scene& s) -> double& { return s.tissue.fibres->angle; }, "rad", 0, 1.5708,
       "angle of the two families to each side of the long axis of the organ: 0 is along the axis, 90 deg around it",
       kChoice},
      {"tissue.relaxation.ratios", [](Scene& s) -> std::vector<double>& { return s.tissue.relaxation->ratios; }, "1",
       1e-6, 1, "per term of the series, the share of a fast strain's stress that relaxes; together below 1",
       kRelaxation},
      {"tissue.relaxation.times", [](Scene& s) -> std::vector<double>& { return s.tissue.relaxation->times; }, "s",
       1e-3, 1e6, "per term, the time in which its share falls to 1/e; five steps at least", kRelaxation},
      {"tissue.mass_damping", [](Scene& s) -> double& { return s.tissue.mass_damping; }, "1/s", 0, 1e4,
       "Rayleigh damping proportional to mass: the velocity of free motion decays to 1/e within 1/mass_damping",
       kChoice},
      {"tissue.stiffness_damping", [](Scene& s) -> double& { return s.tissue.stiffness_damping; }, "s", 0, 1e-3,
       "Rayleigh damping proportional to stiffness: it damps short waves and hardly affects long ones", kChoice},
      {"tissue.iterations", [](Scene& s) -> int& { return s.tissue.iterations; }, "1", 1, 100,
       "quasi-Newton iterations per step, of model shell; a step takes fewer once nothing moves, one where the "
       "organ moves by itself and little changes, and up to 8 more if it does not converge, up to 16 more in the next "
       "few after one that did not arrive; even numbers are more "
       "stable, 1 is for steps of a millisecond",
       kChoice},
      {"tissue.spectral_radius", [](Scene& s) -> double& { return s.tissue.spectral_radius; }, "1", 0, 0.5,
       "amplitude that the fastest vibrations keep over a step, of model shell; 0 removes them within a step. With "
       "more than 0.5, large motions that nothing damps could gain energy",
       "generalised-alpha: Chung, Hulbert 1993, doi 10.1115/1.2900803"},
      {"tissue.self_contact", [](Scene& s) -> bool& { return s.tissue.self_contact; }, "", 0, 0,
       "contact between walls that are pulled together, of model shell", kChoice},
      {"tissue.substeps", [](Scene& s) -> int& { return s.tissue.substeps; }, "1", 0, 1000,
       "substeps per step, of model shape_matching; 0: the fewest that support the stiffness and the gas",
       "many small steps with one iteration each: Macklin 2019, doi 10.1145/3309486.3340247"},
  };
}

std::vector<SchemaRow> environmentRows() {
  return {
      {"attachments.oesophagus", [](Scene& s) -> bool& { return s.attach_oesophagus; }, "", 0, 0,
       "fix the particles at the end of the oesophagus", kChoice},
      {"attachments.duodenum", [](Scene& s) -> bool& { return s.attach_duodenum; }, "", 0, 0,
       "fix the particles at the end of the duodenum", kChoice},
      {"gas.initial_pressure", [](Scene& s) -> double& { return s.gas->initial_pressure; }, "Pa", -5e3, 2e4,
       "gauge pressure at the start", kChoice},
      {"gas.regulated_pressure", [](Scene& s) -> double& { return s.gas->regulated_pressure; }, "Pa", 0, 2e4,
       "gauge pressure at which the insufflator stops",
       "Ushimaru 2020, Sci Rep 10:18169: 10.0 mmHg during gastroscopy in 80 patients"},
      {"gas.flow_limit", [](Scene& s) -> double& { return s.gas->flow_limit; }, "m^3/s", 0, 1e-2,
       "largest flow of the insufflator, as volume at ambient pressure", "3 L/min, design choice"},
      {"gas.insufflator_on", [](Scene& s) -> bool& { return s.gas->insufflator_on; }, "", 0, 0,
       "insufflator is on at the start", kChoice},
      {"gravity.acceleration", [](Scene& s) -> Eigen::Vector3d& { return s.gravity->acceleration; }, "m/s^2", -100, 100,
       "gravitational acceleration; x is anterior, so the default is a patient lying on the back; acts on the wall "
       "where "
       "`foundation.carries_weight` is false",
       "standard gravity, rounded"},
      {"foundation.stiffness", [](Scene& s) -> double& { return s.foundation->stiffness; }, "Pa/m", 0, 1e7,
       "stiffness of the neighbouring organs per area of the wall", kChoice},
      {"foundation.carries_weight", [](Scene& s) -> bool& { return s.foundation->carries_weight; }, "", 0, 0,
       "the foundation balances the weight, whatever its direction, so that the organ is at rest in its given shape",
       kChoice},
      {"breathing.rate", [](Scene& s) -> double& { return s.breathing->rate; }, "1/s", 0.01, 2, "breaths",
       "16 per minute, the middle of the 12 to 20 of adults at rest"},
      {"breathing.amplitude", [](Scene& s) -> double& { return s.breathing->amplitude; }, "m", 0, 0.05,
       "from the end of an expiration to that of an inspiration",
       "the centre of mass of the default stomach then has a standard deviation of 5.8 mm; 2.7 to 8.8 mm in 18 "
       "volunteers (MRI, PMC10113698)"},
      {"breathing.deformation", [](Scene& s) -> double& { return s.breathing->deformation; }, "m", 0, 0.05,
       "by how much less the foundation at the pylorus moves than at the apex of the fundus", "a rigid foundation"},
      {"breathing.inspiration", [](Scene& s) -> double& { return s.breathing->inspiration; }, "1", 0.1, 0.9,
       "share of a breath that is inspiration", "a symmetric breath"},
  };
}

std::vector<SchemaRow> motionRows() {
  return {
      {"motion.grade", [](Scene& s) -> int& { return s.motion->grade; }, "1", 0, 3,
       "of all amplitudes, those of respiration too unless `breathing` states them: 0 none, 1 slight (half), 2 the "
       "healthy mean, 3 strong (1.25 times)",
       "3 is one standard deviation between waves above the mean: 58 +- 14 % of the lumen (2001, doi "
       "10.1046/j.1365-2982.2001.00285.x)"},
      {"motion.wave_rate", [](Scene& s) -> double& { return s.motion->wave_rate; }, "1/s", 0.005, 0.2,
       "contraction waves from mid corpus to pylorus",
       "2.83 per minute, within one standard deviation of 3.0 +- 0.2 per minute (28 volunteers, MRI, same paper) and "
       "of a period of 23 +- 2 s (Kwiatek 2006, doi 10.1002/jmri.20738)"},
      {"motion.wave_speed", [](Scene& s) -> double& { return s.motion->wave_speed; }, "m/s", 1e-4, 0.02,
       "of a wave in the distal antrum, the last 6 cm; it begins at mid corpus with 0.45 times that",
       "2.7 +- 0.1 mm/s in the distal antrum (Kwiatek 2006); in the proximal antrum it has then the 1.6 +- 0.2 mm/s of "
       "the first paper"},
      {"motion.wave_amplitude", [](Scene& s) -> double& { return s.motion->wave_amplitude; }, "m", 0, 0.02,
       "by how much the wall moves inwards at the crest of a wave", "7.0 +- 0.8 mm (Kwiatek 2006)"},
      {"motion.wave_width", [](Scene& s) -> double& { return s.motion->wave_width; }, "m", 5e-3, 0.1,
       "full width at half height of the contraction at the pylorus; 6 % less per centimetre towards it",
       "the fall: Kwiatek 2006; the width: design choice"},
      {"motion.heart_rate", [](Scene& s) -> double& { return s.motion->heart_rate; }, "1/s", 0.3, 4,
       "beats of the heart", "70 per minute, an adult at rest"},
      {"motion.heart_amplitude", [](Scene& s) -> double& { return s.motion->heart_amplitude; }, "m", 0, 5e-3,
       "by how much a beat moves the foundation beside the cardia", kChoice},
  };
}

std::vector<SchemaRow> complianceRows() {
  return {
      {"scope.compliance.shaft_rigidity", [](Scene& s) -> double& { return s.scope->compliance->shaft_rigidity; },
       "N m^2", 1e-3, 1e4, "flexural rigidity of the insertion tube, clamped where it enters the lumen", kFlexural},
      {"scope.compliance.torsional_rigidity",
       [](Scene& s) -> double& { return s.scope->compliance->torsional_rigidity; }, "N m^2", 1e-3, 1e4,
       "torsional rigidity of the insertion tube", kTorsional},
      {"scope.compliance.outer_length", [](Scene& s) -> double& { return s.scope->compliance->outer_length; }, "m", 0,
       2, "length of tube between the hand and the entry, which twists too",
       "incisors to oesophagogastric junction, about 40 cm"},
      {"scope.compliance.axial_stiffness", [](Scene& s) -> double& { return s.scope->compliance->axial_stiffness; },
       "N/m", 10, 1e7, "stiffness along the insertion, between hand and tip",
       "design choice: 10 N take up 5 mm of the slack of a tube in pharynx and oesophagus"},
      {"scope.compliance.bending_stiffness", [](Scene& s) -> double& { return s.scope->compliance->bending_stiffness; },
       "N m/rad", 1e-3, 1e4, "stiffness of the bending section per total bend, wheels held",
       "design choice: 1.2 m of 0.7 mm wire rope (100 GPa, 0.2 mm^2) 4.5 mm from the axis has 0.34, its conduit gives "
       "too"},
      {"scope.compliance.relaxation_time", [](Scene& s) -> double& { return s.scope->compliance->relaxation_time; },
       "s", 0, 1, "viscosity over stiffness of the whole scope",
       "design choice: within three frames of its end, as rubber and rubbing wires damp it"},
  };
}

std::vector<SchemaRow> toolRows() {
  return {
      {"scope.urdf", [](Scene& s) -> std::string& { return s.scope->urdf; }, "", 0, 0,
       "URDF of endoscope and suturing device: a `package://` path, or a path relative to the scene file", kChoice},
      {"scope.friction", [](Scene& s) -> double& { return s.scope->friction; }, "1", 0, 2,
       "Coulomb friction coefficient between tool and mucosa", kChoice},
      {"scope.needle_arm", [](Scene& s) -> bool& { return s.scope->needle_arm; }, "", 0, 0,
       "arm and hook are a body for the wall, with this friction; else they are drawn. Of model shell", kChoice},
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
    for (auto* group : {topRows, geometryRows, meshRows, tissueRows, environmentRows, motionRows, toolRows,
                        complianceRows, procedureRows}) {
      for (const SchemaRow& row : group()) all.push_back(row);
    }
    return all;
  }();
  return rows;
}

}  // namespace vibe
