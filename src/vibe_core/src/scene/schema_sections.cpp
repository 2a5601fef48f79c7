#include "vibe_core/scene/schema.hpp"

namespace vibe {

const std::vector<SchemaSection>& sceneSections() {
  static const auto nothing = [](Scene&) {};
  static const auto always = [](const Scene&) { return true; };
  static const std::vector<SchemaSection> sections = {
      {"", "The top level.", nothing, always},
      {"geometry", "Shape and resolution of the organ.", nothing, always},
      {"geometry.landmarks", "The four points from which regions and walls of an imported surface are found.", nothing,
       [](const Scene& s) { return s.geometry.oesophagus.has_value(); }},
      {"tissue", "The wall.", nothing, always},
      {"tissue.thickness", "Thickness of the wall by region.", nothing, always},
      {"tissue.stiffness", "Stiffness of the wall by region, of model shell.", nothing, always},
      {"tissue.fibres",
       "Fibres in the wall, of model shell (Holzapfel, Gasser, Ogden 2000). Without this section there are none.",
       [](Scene& s) { s.tissue.fibres.emplace(); }, [](const Scene& s) { return s.tissue.fibres.has_value(); }},
      {"attachments", "Ends that are fixed. Without any the organ is free.", nothing, always},
      {"gas", "Gas in the lumen, and an insufflator. Without this section there is no pressure in the lumen.",
       [](Scene& s) { s.gas.emplace(); }, [](const Scene& s) { return s.gas.has_value(); }},
      {"gravity", "Weight of the wall.", [](Scene& s) { s.gravity.emplace(); },
       [](const Scene& s) { return s.gravity.has_value(); }},
      {"foundation", "Neighbouring organs, modelled as springs from every particle to its position at rest.",
       [](Scene& s) { s.foundation.emplace(); }, [](const Scene& s) { return s.foundation.has_value(); }},
      {"scope", "The endoscope with its suturing device.", [](Scene& s) { s.scope.emplace(); },
       [](const Scene& s) { return s.scope.has_value(); }},
      {"scope.base", "Pose of the root link. Without this section the scope enters at the oesophagus.",
       [](Scene& s) { s.scope->base_from_anatomy = false; },
       [](const Scene& s) { return s.scope.has_value() && !s.scope->base_from_anatomy; }},
      {"scope.compliance",
       "Bending section and shaft give way under load, so that the tip is not where the hand commands it. Without this "
       "section the scope is rigid.",
       [](Scene& s) { s.scope->compliance.emplace(); },
       [](const Scene& s) { return s.scope.has_value() && s.scope->compliance.has_value(); }},
      {"helix", "Tissue helix of the suturing device; needs `scope`.", [](Scene& s) { s.helix.emplace(); },
       [](const Scene& s) { return s.helix.has_value(); }, "scope", "whose tool carries the helix"},
      {"suture",
       "Needle, thread, T-tag and cinch of the suturing device; needs `helix`. Without this section "
       "the needle takes no bites.",
       [](Scene& s) { s.suture.emplace(); }, [](const Scene& s) { return s.suture.has_value(); }, "helix",
       "which brings the wall to the needle"},
      {"bleeding", "Bleeding after a bite, random from the seed; needs `suture`. Without this section no bite bleeds.",
       [](Scene& s) { s.bleeding.emplace(); }, [](const Scene& s) { return s.bleeding.has_value(); }, "suture",
       "whose bites bleed"},
      {"marking",
       "Argon plasma coagulation from a probe in the scope: marks and burns ([marking.md](marking.md)); needs `scope`. "
       "Without this section the pedal has no effect.",
       [](Scene& s) { s.marking.emplace(); }, [](const Scene& s) { return s.marking.has_value(); }, "scope",
       "whose tip carries the probe"},
  };
  return sections;
}

}  // namespace vibe
