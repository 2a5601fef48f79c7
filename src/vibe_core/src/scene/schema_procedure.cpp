#include "scene/schema_rows.hpp"

namespace vibe {
namespace {

constexpr const char* kChoice = "design choice";
constexpr const char* kNoRate = "design choice, no rate is published";

std::vector<SchemaRow> helixRows() {
  return {
      {"helix.reach", [](Scene& s) -> double& { return s.helix->reach; }, "m", 1e-4, 5e-2,
       "the helix grabs if a particle is this near to its tip", kChoice},
      {"helix.grip_radius", [](Scene& s) -> double& { return s.helix->grip_radius; }, "m", 1e-4, 5e-2,
       "particles within this distance of the grabbed one are held too", kChoice},
      {"helix.hold_force", [](Scene& s) -> double& { return s.helix->hold_force; }, "N", 0, 1000,
       "turned in as far as it goes, the helix slips above this force",
       "largest instrument tip force seen in transgastric surgery: Trejos 2011, Surg Endosc 25:186"},
      {"helix.hold_turns", [](Scene& s) -> double& { return s.helix->hold_turns; }, "1", 0, 20,
       "turns into the tissue after which it holds with all of hold_force; 0: at once",
       "2 to 4 rotations to reach the muscle (Wikipedia, \"Endoscopic sleeve gastroplasty\")"},
      {"helix.initial_hold_force", [](Scene& s) -> double& { return s.helix->initial_hold_force; }, "N", 0, 1000,
       "the helix slips above this force without a turn; from here to hold_force it grows with the turns", kChoice},
  };
}

std::vector<SchemaRow> threadRows() {
  return {
      {"suture.bite_radius", [](Scene& s) -> double& { return s.suture->bite_radius; }, "m", 1e-4, 5e-2,
       "the thread pulls on the particles this near to a bite", kChoice},
      {"suture.thread_stiffness", [](Scene& s) -> double& { return s.suture->thread_stiffness; }, "N", 1, 1e5,
       "tension per strain of the thread",
       "polypropylene sutures at 4.03 GPa (Nindhia 2021, doi 10.22159/ijap.2021.v13s1.Y1025), diameter of USP 2-0, "
       "0.30 to "
       "0.339 mm (USP <861>)"},
      {"suture.thread_friction", [](Scene& s) -> double& { return s.suture->thread_friction; }, "1", 0, 2,
       "Coulomb friction of the thread in the tissue; over a bite the tension may differ by the capstan factor",
       "design choice: usual of lubricated polymer pairs"},
      {"suture.thread_strength", [](Scene& s) -> double& { return s.suture->thread_strength; }, "N", 0.05, 1000,
       "the thread breaks above this tension",
       "least mean knot-pull strength of USP 2-0 non-absorbable, class I, 1.44 kgf (USP <881>)"},
      {"suture.thread_length", [](Scene& s) -> double& { return s.suture->thread_length; }, "m", 0.05, 10,
       "of one thread, from the T-tag to where the device lets it go", kChoice},
      {"suture.pull_out_force", [](Scene& s) -> double& { return s.suture->pull_out_force; }, "N", 0, 1000,
       "the thread tears out of a full-thickness bite above this force, out of a partial one earlier",
       "order of magnitude: endoscopic hand suturing with 3 points held 7.3 N in porcine mucosa (2014, doi "
       "10.1055/s-0034-1377180)"},
  };
}

std::vector<SchemaRow> setRows() {
  return {
      {"suture.least_bites", [](Scene& s) -> int& { return s.suture->min_bites; }, "1", 2, 32,
       "bites of a set that can be cinched", "two points are the least that a thread can draw together"},
      {"suture.most_bites", [](Scene& s) -> int& { return s.suture->max_bites; }, "1", 2, 1000, "bites of a set",
       "design choice, beyond the usual 6 to 9 bites (Kumbhari 2017, VideoGIE, doi 10.1016/j.vgie.2017.01.002)"},
      {"suture.cinch_speed", [](Scene& s) -> double& { return s.suture->cinch_speed; }, "m/s", 1e-4, 1,
       "at which the cinch draws thread", kChoice},
      {"suture.cinch_tension", [](Scene& s) -> double& { return s.suture->cinch_tension; }, "N", 0.02, 1000,
       "tension at which the cinch stops drawing",
       "order of magnitude: the wall's 48 N/m at 10 mmHg over the 2 to 6 cm that a bite gathers"},
      {"suture.loose_tension", [](Scene& s) -> double& { return s.suture->loose_tension; }, "N", 0, 999,
       "a set cinched with less than this is loose", kChoice},
      {"suture.cinch_model",
       [](Scene& s) -> std::string& { return s.suture->cinch_model; },
       "",
       0,
       0,
       "how a set draws the wall together: `thread`, the cinch shortens it; `groups`, equation 5 of the ViBE prototype",
       kChoice,
       std::nullopt,
       nullptr,
       false,
       {"thread", "groups"}},
      {"suture.strain_limit", [](Scene& s) -> double& { return s.suture->strain_limit; }, "1", 0.01, 2,
       "`groups` stops drawing when the wall at a drawn particle is this much longer or shorter than at rest",
       "design choice for the prototype's \"elastic limit\", of which it gives no figure"},
      {"suture.group_particles", [](Scene& s) -> int& { return s.suture->group_particles; }, "1", 1, 1000,
       "most particles between two bites that `groups` draws, of techniques other than U and Z",
       "five in the ViBE prototype (Erden et al., section 2.1.3)"},
      {"suture.classifier",
       [](Scene& s) -> std::string& { return s.suture->classifier; },
       "",
       0,
       0,
       "how the stitch is recognised: `corrected`, or `printed`, equations 1 to 4 of the ViBE prototype to the letter",
       "equation 2 as printed cannot see a U with right angles",
       std::nullopt,
       nullptr,
       false,
       {"corrected", "printed"}},
  };
}

std::vector<SchemaRow> bleedingRows() {
  return {
      {"bleeding.mild_probability", [](Scene& s) -> double& { return s.bleeding->mild_probability; }, "1", 0, 1,
       "part of the bites that bleed mildly", kNoRate},
      {"bleeding.brisk_probability", [](Scene& s) -> double& { return s.bleeding->brisk_probability; }, "1", 0, 1,
       "part of the bites that bleed briskly, until the set is cinched", kNoRate},
      {"bleeding.mild_rate", [](Scene& s) -> double& { return s.bleeding->mild_rate; }, "m^3/s", 0, 1e-4,
       "blood lost per time from a mild one", kNoRate},
      {"bleeding.brisk_rate", [](Scene& s) -> double& { return s.bleeding->brisk_rate; }, "m^3/s", 0, 1e-4,
       "blood lost per time from a brisk one", kNoRate},
      {"bleeding.mild_duration", [](Scene& s) -> double& { return s.bleeding->mild_duration; }, "s", 0, 1e5,
       "after which a mild one stops by itself", kNoRate},
      {"bleeding.brisk_time", [](Scene& s) -> double& { return s.bleeding->brisk_time; }, "s", 0, 1e5,
       "within which the set is to be completed when a bite bleeds briskly", kNoRate},
  };
}

std::vector<SchemaRow> probeRows() {
  return {
      {"marking.power", [](Scene& s) -> double& { return s.marking->apc.power; }, "W", 0, 200,
       "setting of the argon plasma generator", "20 and 40 W: Fetz 2021, Endosc Int Open 9:E790"},
      {"marking.efficiency", [](Scene& s) -> double& { return s.marking->apc.efficiency; }, "1", 0, 1,
       "part of the power that reaches the tissue", "published energies are those of the generator's setting"},
      {"marking.argon_flow", [](Scene& s) -> double& { return s.marking->apc.argon_flow; }, "m^3/s", 0, 1e-4,
       "argon from the probe while the pedal is down; it cools the spot", "1.0 to 1.4 L/min: Fetz 2021"},
      {"marking.probe_length", [](Scene& s) -> double& { return s.marking->apc.probe_length; }, "m", 0, 0.1,
       "of the probe beyond the tip of the scope", kChoice},
      {"marking.reach", [](Scene& s) -> double& { return s.marking->apc.reach; }, "m", 0, 0.05,
       "from the probe's end to tissue", "a maker of probes (emed) names 3 mm in endoscopes and 5 mm in open surgery"},
      {"marking.spot_radius", [](Scene& s) -> double& { return s.marking->apc.spot_radius; }, "m", 5e-4, 0.02,
       "of the footprint where the probe touches", "design choice: as wide as particles are apart"},
      {"marking.spread", [](Scene& s) -> double& { return s.marking->apc.spread; }, "rad", 0, 1,
       "half angle by which the footprint widens with the distance", kChoice},
      {"marking.deformation",
       [](Scene& s) -> std::string& { return s.marking->deformation; },
       "",
       0,
       0,
       "what the wall does while the pedal is down: `solver`, as ever; `gradient`, it gives way to the tool in the "
       "gradient domain, without forces, as in the ViBE prototype",
       "the shell is more exact at the same rate",
       std::nullopt,
       nullptr,
       false,
       {"solver", "gradient"}},
  };
}

std::vector<SchemaRow> burnRows() {
  return {
      {"marking.mark_energy", [](Scene& s) -> double& { return s.marking->apc.mark_energy; }, "J", 1e-3, 1e5,
       "given to one spot at 40 W makes a mark", "design choice below 40 to 80 J (20 to 40 W for 2 s, Fetz 2021)"},
      {"marking.burn_energy", [](Scene& s) -> double& { return s.marking->apc.burn_energy; }, "J", 1e-3, 1e5,
       "given to one spot at 40 W makes a burn scar",
       "0.71, the part of the particle nearest to an aim between them, of 600 J (J Gastroenterol Hepatol 2017)"},
      {"marking.deep_energy", [](Scene& s) -> double& { return s.marking->apc.deep_energy; }, "J", 1e-3, 1e5,
       "given to one spot at 40 W puts the muscularis at risk",
       "J Gastroenterol Hepatol 2017: 600 to 800 J harm mucosa and submucosa only"},
      {"marking.tissue_cooling", [](Scene& s) -> double& { return s.marking->apc.tissue_cooling; }, "1/s", 0, 10,
       "rate at which a spot loses heat to the tissue around",
       "design choice: diffusion of heat in water over the spot's radius"},
      {"marking.argon_cooling", [](Scene& s) -> double& { return s.marking->apc.argon_cooling; }, "1/s", 0, 10,
       "the same to the argon, per L/min, under the beam", kChoice},
      {"marking.insufflation_cooling", [](Scene& s) -> double& { return s.marking->apc.insufflation_cooling; }, "1/s",
       0, 10, "the same to the insufflator's gas, per L/min, everywhere", kChoice},
  };
}

}  // namespace

std::vector<SchemaRow> procedureRows() {
  std::vector<SchemaRow> all;
  for (auto* group : {helixRows, threadRows, setRows, bleedingRows, probeRows, burnRows}) {
    for (const SchemaRow& row : group()) all.push_back(row);
  }
  return all;
}

}  // namespace vibe
