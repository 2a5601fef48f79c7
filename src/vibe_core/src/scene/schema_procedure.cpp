#include "scene/scene_keys.hpp"

namespace vibe {
namespace {

constexpr const char* kNoRate = "design choice, no rate is published";

std::vector<SchemaRow> helixRows() {
  return {
      {"helix.reach", [](Scene& s) -> double& { return s.helix->reach; }, "m", 1e-4, 5e-2,
       "the helix grips if the wall is within this distance of its tip", kChoice},
      {"helix.grip_radius", [](Scene& s) -> double& { return s.helix->grip_radius; }, "m", 1e-4, 5e-2,
       "of the disc of the wall at rest that the helix holds, around the point nearest to its tip", kChoice},
      {"helix.hold_force", [](Scene& s) -> double& { return s.helix->hold_force; }, "N", 0, 1000,
       "force above which the helix slips when it is fully turned in",
       "largest instrument tip force seen in transgastric surgery: Trejos 2011, Surg Endosc 25:186"},
      {"helix.hold_turns", [](Scene& s) -> double& { return s.helix->hold_turns; }, "1", 0, 20,
       "turns into the tissue after which the helix is fully turned in; 0: at once",
       "2 to 4 rotations to reach the muscle (Wikipedia, \"Endoscopic sleeve gastroplasty\")"},
      {"helix.initial_hold_force", [](Scene& s) -> double& { return s.helix->initial_hold_force; }, "N", 0, 1000,
       "force above which the helix slips before its first turn; with the turns it grows linearly to hold_force",
       kChoice},
  };
}

std::vector<SchemaRow> threadRows() {
  return {
      {"suture.bite_radius", [](Scene& s) -> double& { return s.suture->bite_radius; }, "m", 1e-4, 5e-2,
       "of the disc of the wall at rest on which the thread pulls evenly, around the place of a bite", kChoice},
      {"suture.thread_stiffness", [](Scene& s) -> double& { return s.suture->thread_stiffness; }, "N", 1, 1e5,
       "tension per strain of the thread",
       "polypropylene sutures at 4.03 GPa (Nindhia 2021, doi 10.22159/ijap.2021.v13s1.Y1025), diameter of USP 2-0, "
       "0.30 to 0.339 mm (USP <861>)"},
      {"suture.thread_friction", [](Scene& s) -> double& { return s.suture->thread_friction; }, "1", 0, 2,
       "Coulomb friction coefficient between thread and tissue; across a bite the tension changes by at most the "
       "capstan factor",
       "design choice: typical of lubricated polymer pairs"},
      {"suture.thread_strength", [](Scene& s) -> double& { return s.suture->thread_strength; }, "N", 0.05, 1000,
       "tension above which the thread breaks",
       "minimum mean knot-pull strength of USP 2-0 non-absorbable, class I, 1.44 kgf (USP <881>)"},
      {"suture.thread_length", [](Scene& s) -> double& { return s.suture->thread_length; }, "m", 0.05, 10,
       "length of one thread, from the T-tag to the point where the device releases it", kChoice},
      {"suture.pull_out_force", [](Scene& s) -> double& { return s.suture->pull_out_force; }, "N", 0, 1000,
       "force above which the thread tears out of a full-thickness bite; a partial-thickness bite holds less",
       "order of magnitude: endoscopic hand suturing with 3 points held 7.3 N in porcine mucosa (2014, doi "
       "10.1055/s-0034-1377180)"},
  };
}

std::vector<SchemaRow> setRows() {
  return {
      {"suture.min_bites", [](Scene& s) -> int& { return s.suture->min_bites; }, "1", 2, 32,
       "bites that a set needs to be cinched", "a thread can draw no fewer than two points together"},
      {"suture.max_bites", [](Scene& s) -> int& { return s.suture->max_bites; }, "1", 2, 1000,
       "bites that a set can have",
       "design choice, beyond the usual 6 to 9 bites (Kumbhari 2017, VideoGIE, doi 10.1016/j.vgie.2017.01.002)"},
      {"suture.cinch_speed", [](Scene& s) -> double& { return s.suture->cinch_speed; }, "m/s", 1e-4, 1,
       "speed at which the cinch draws thread", kChoice},
      {"suture.cinch_tension", [](Scene& s) -> double& { return s.suture->cinch_tension; }, "N", 0.02, 1000,
       "tension at which the cinch stops drawing",
       "order of magnitude: the wall's 48 N/m at 10 mmHg over the 2 to 6 cm that a bite gathers"},
      {"suture.loose_tension", [](Scene& s) -> double& { return s.suture->loose_tension; }, "N", 0, 999,
       "a set that is cinched with less tension is loose", kChoice},
      {"suture.cinch_model", [](Scene& s) -> std::string& { return s.suture->cinch_model; }, "", 0, 0,
       "how a cinched set draws the wall together: `thread` shortens the thread; `groups` uses equation 5 of the ViBE "
       "prototype",
       kChoice},
      {"suture.strain_limit", [](Scene& s) -> double& { return s.suture->strain_limit; }, "1", 0.01, 2,
       "strain of the wall, in tension or compression, at which `groups` stops drawing a particle",
       "design choice: the ViBE prototype states no value for its \"elastic limit\""},
      {"suture.group_particles", [](Scene& s) -> int& { return s.suture->group_particles; }, "1", 1, 1000,
       "maximum number of particles between two bites that `groups` draws, for techniques other than U and Z",
       "five in the ViBE prototype (Erden et al., section 2.1.3)"},
      {"suture.classifier",
       [](Scene& s) -> std::string& { return s.suture->classifier; },
       "",
       0,
       0,
       "how the suture technique is recognised: `printed` uses equations 1 to 4 of the ViBE prototype as printed, "
       "`corrected` the corrected ones",
       "equation 2 as printed does not recognise a U with right angles",
       std::nullopt,
       nullptr,
       false,
       {"corrected", "printed"}},
  };
}

std::vector<SchemaRow> bleedingRows() {
  return {
      {"bleeding.mild_probability", [](Scene& s) -> double& { return s.bleeding->mild_probability; }, "1", 0, 1,
       "probability that a bite bleeds mildly", kNoRate},
      {"bleeding.brisk_probability", [](Scene& s) -> double& { return s.bleeding->brisk_probability; }, "1", 0, 1,
       "probability that a bite bleeds briskly, which lasts until the set is cinched", kNoRate},
      {"bleeding.mild_rate", [](Scene& s) -> double& { return s.bleeding->mild_rate; }, "m^3/s", 0, 1e-4,
       "blood loss of a mild bleeding", kNoRate},
      {"bleeding.brisk_rate", [](Scene& s) -> double& { return s.bleeding->brisk_rate; }, "m^3/s", 0, 1e-4,
       "blood loss of a brisk bleeding", kNoRate},
      {"bleeding.mild_duration", [](Scene& s) -> double& { return s.bleeding->mild_duration; }, "s", 0, 1e5,
       "time after which mild bleeding stops by itself", kNoRate},
      {"bleeding.brisk_time", [](Scene& s) -> double& { return s.bleeding->brisk_time; }, "s", 0, 1e5,
       "time within which the set should be completed when a bite bleeds briskly", kNoRate},
  };
}

std::vector<SchemaRow> probeRows() {
  return {
      {"marking.power", [](Scene& s) -> double& { return s.marking->apc.power; }, "W", 0, 200,
       "power setting of the argon plasma generator", "20 and 40 W: Fetz 2021, Endosc Int Open 9:E790"},
      {"marking.efficiency", [](Scene& s) -> double& { return s.marking->apc.efficiency; }, "1", 0, 1,
       "share of the power that reaches the tissue", "published energies are those of the generator setting"},
      {"marking.argon_flow", [](Scene& s) -> double& { return s.marking->apc.argon_flow; }, "m^3/s", 0, 1e-4,
       "argon flow from the probe while the pedal is down; it cools the spot", "1.0 to 1.4 L/min: Fetz 2021"},
      {"marking.probe_length", [](Scene& s) -> double& { return s.marking->apc.probe_length; }, "m", 0, 0.1,
       "length of the probe beyond the tip of the scope", kChoice},
      {"marking.reach", [](Scene& s) -> double& { return s.marking->apc.reach; }, "m", 0, 0.05,
       "largest distance from the end of the probe to tissue at which the beam ignites",
       "manufacturer (emed): 3 mm in endoscopes, 5 mm in open surgery"},
      {"marking.spot_radius", [](Scene& s) -> double& { return s.marking->apc.spot_radius; }, "m", 5e-4, 0.02,
       "radius of the footprint when the probe touches the tissue", "design choice: the spacing of the particles"},
      {"marking.spread", [](Scene& s) -> double& { return s.marking->apc.spread; }, "rad", 0, 1,
       "half angle at which the footprint widens with distance", kChoice},
      {"marking.deformation", [](Scene& s) -> std::string& { return s.marking->deformation; }, "", 0, 0,
       "how the wall deforms while the pedal is down: `solver` keeps the tissue model; `gradient` makes the wall give "
       "way to the tool in the gradient domain, without forces, as in the ViBE prototype",
       "the shell is more accurate at the same rate"},
  };
}

std::vector<SchemaRow> burnRows() {
  return {
      {"marking.mark_energy", [](Scene& s) -> double& { return s.marking->apc.mark_energy; }, "J", 1e-3, 1e5,
       "energy on one spot, at 40 W, that makes a mark",
       "design choice below 40 to 80 J (20 to 40 W for 2 s, Fetz 2021)"},
      {"marking.burn_energy", [](Scene& s) -> double& { return s.marking->apc.burn_energy; }, "J", 1e-3, 1e5,
       "energy on one spot, at 40 W, that makes a burn scar",
       "600 J (J Gastroenterol Hepatol 2017) times 0.71, the share of the nearest particle if the beam aims between "
       "particles"},
      {"marking.deep_energy", [](Scene& s) -> double& { return s.marking->apc.deep_energy; }, "J", 1e-3, 1e5,
       "energy on one spot, at 40 W, that puts the muscularis at risk",
       "J Gastroenterol Hepatol 2017: 600 to 800 J damage mucosa and submucosa only"},
      {"marking.tissue_cooling", [](Scene& s) -> double& { return s.marking->apc.tissue_cooling; }, "1/s", 0, 10,
       "rate at which a spot loses heat to the surrounding tissue",
       "design choice: diffusion of heat in water over the radius of the spot"},
      {"marking.argon_cooling", [](Scene& s) -> double& { return s.marking->apc.argon_cooling; }, "1/s", 0, 10,
       "rate at which a spot under the beam loses heat to the argon, per L/min", kChoice},
      {"marking.insufflation_cooling", [](Scene& s) -> double& { return s.marking->apc.insufflation_cooling; }, "1/s",
       0, 10, "rate at which every spot loses heat to the gas of the insufflator, per L/min", kChoice},
  };
}

std::vector<SchemaRow> inspectionRows() {
  return {
      {"inspection.field_of_view", [](Scene& s) -> double& { return s.inspection->field_of_view; }, "rad", 0.1, 3,
       "of the lens, from side to side of its round picture",
       "140 degrees, as of most gastroscopes and of the endoscope camera"},
      {"inspection.distance", [](Scene& s) -> double& { return s.inspection->distance; }, "m", 5e-3, 1,
       "distance from the lens up to which the wall is lit and in focus",
       "design choice, of the order of the far end of a gastroscope's depth of field"},
      {"inspection.angle", [](Scene& s) -> double& { return s.inspection->angle; }, "rad", 0.1, 1.5708,
       "angle between line of sight and normal of the wall up to which it is not too oblique", kChoice},
  };
}

}  // namespace

std::vector<SchemaRow> procedureRows() {
  std::vector<SchemaRow> all;
  for (auto* group : {helixRows, threadRows, setRows, bleedingRows, probeRows, burnRows, inspectionRows}) {
    for (const SchemaRow& row : group()) all.push_back(row);
  }
  return all;
}

}  // namespace vibe
