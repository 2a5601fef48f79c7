#include "schema_rows.hpp"

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
      {"helix.prick_force", [](Scene& s) -> double& { return s.helix->prick_force; }, "N", 0, 1000,
       "the helix slips above this force without a turn; from here to hold_force it grows with the turns", kChoice},
  };
}

std::vector<SchemaRow> threadRows() {
  return {
      {"suture.bite_radius", [](Scene& s) -> double& { return s.suture->bite_radius; }, "m", 1e-4, 5e-2,
       "the thread pulls on the particles this near to a bite", kChoice},
      {"suture.thread_stiffness", [](Scene& s) -> double& { return s.suture->thread_stiffness; }, "N", 1, 1e5,
       "tension per strain of the thread",
       "design choice: polypropylene at 3 GPa with the diameter of USP 2-0, 0.30 to 0.339 mm (USP <861>)"},
      {"suture.thread_friction", [](Scene& s) -> double& { return s.suture->thread_friction; }, "1", 0, 2,
       "Coulomb friction of the thread in the tissue; over a bite the tension may differ by the capstan factor",
       kChoice},
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
      {"suture.least_bites", [](Scene& s) -> int& { return s.suture->least_bites; }, "1", 2, 32,
       "bites of a set that can be cinched", "two points are the least that a thread can draw together"},
      {"suture.most_bites", [](Scene& s) -> int& { return s.suture->most_bites; }, "1", 2, 1000, "bites of a set",
       "design choice, beyond the usual 6 to 9 bites (Kumbhari 2017, VideoGIE, doi 10.1016/j.vgie.2017.01.002)"},
      {"suture.cinch_speed", [](Scene& s) -> double& { return s.suture->cinch_speed; }, "m/s", 1e-4, 1,
       "at which the cinch draws thread", kChoice},
      {"suture.cinch_tension", [](Scene& s) -> double& { return s.suture->cinch_tension; }, "N", 0.02, 1000,
       "tension at which the cinch stops drawing",
       "order of magnitude: the wall's 48 N/m at 10 mmHg over the 2 to 6 cm that a bite gathers"},
      {"suture.loose_tension", [](Scene& s) -> double& { return s.suture->loose_tension; }, "N", 0, 999,
       "a set cinched with less than this is loose", kChoice},
      {"suture.pulling",
       [](Scene& s) -> std::string& { return s.suture->pulling; },
       "",
       0,
       0,
       "how a set draws the wall together: `thread`, the cinch shortens it; `groups`, equation 5 of the ViBE prototype",
       kChoice,
       std::nullopt,
       nullptr,
       false,
       {"thread", "groups"}},
      {"suture.technique_rule",
       [](Scene& s) -> std::string& { return s.suture->technique_rule; },
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

}  // namespace

std::vector<SchemaRow> procedureRows() {
  std::vector<SchemaRow> all;
  for (auto* group : {helixRows, threadRows, setRows, bleedingRows}) {
    for (const SchemaRow& row : group()) all.push_back(row);
  }
  return all;
}

}  // namespace vibe
