#pragma once
#include "vibe_core/state/procedure_state.hpp"
#include "vibe_core/state/pull_spring.hpp"

namespace vibe {

// One list of the members of ProcedureState and PullSpring for all that store or hash it. The members are taken apart
// by name, so that one that is added to a struct and not to its list here does not compile. An archive has value() for
// a plain value, vector() for an Eigen::Vector3d, numbers() for a std::vector of plain values and list() for a
// std::vector of anything, with a function for its items.

template <class Archive, class B>
void visitBite(Archive& archive, B& bite) {
  auto& [particle, weight, time, depth, thickness, region, wall, along] = bite;
  archive.numbers(particle);
  archive.numbers(weight);
  archive.value(time);
  archive.value(depth);
  archive.value(thickness);
  archive.value(region);
  archive.value(wall);
  archive.value(along);
}

template <class Archive, class G>
void visitGroup(Archive& archive, G& group) {
  auto& [particle, offset, middle, weight, drawn] = group;
  archive.numbers(particle);
  archive.list(offset, [&archive](auto& place) { archive.vector(place); });
  archive.numbers(middle);
  archive.numbers(weight);
  archive.value(drawn);
}

template <class Archive, class S>
void visitSuture(Archive& archive, S& suture) {
  auto& [stage, bites, length, tension, taken, technique, technique_margin, transitions, pulled, cinch_tension, begin,
         end, tear_outs, group] = suture;
  archive.value(stage);
  archive.list(bites, [&archive](auto& bite) { visitBite(archive, bite); });
  archive.numbers(length);
  archive.numbers(tension);
  archive.list(taken, [&archive](auto& place) { archive.vector(place); });
  archive.value(technique);
  archive.value(technique_margin);
  archive.value(transitions);
  archive.value(pulled);
  archive.value(cinch_tension);
  archive.value(begin);
  archive.value(end);
  archive.value(tear_outs);
  visitGroup(archive, group);
}

template <class Archive, class B>
void visitBleeding(Archive& archive, B& bleeding) {
  auto& [suture, bite, particle, brisk, begin, rate, amount, overdue] = bleeding;
  archive.value(suture);
  archive.value(bite);
  archive.value(particle);
  archive.value(brisk);
  archive.value(begin);
  archive.value(rate);
  archive.value(amount);
  archive.value(overdue);
}

template <class Archive, class H>
void visitPullSpring(Archive& archive, H& pull) {
  auto& [particle, node, weight, target, force] = pull;
  archive.value(particle);
  archive.numbers(node);
  archive.numbers(weight);
  archive.vector(target);
  archive.vector(force);
}

template <class Archive, class P>
void visitProcedure(Archive& archive, P& procedure) {
  auto& [phase, pressed, heat, dose, grade, beam_energy, base_x, base_y, base_z, grip_rotation, grip_turns, arm_closed,
         needle_on_arm, needle_loaded, pierced, pending, sutures, thread_used, bleedings, blood_lost] = procedure;
  archive.value(phase);
  archive.value(pressed);
  archive.numbers(heat);
  archive.numbers(dose);
  archive.numbers(grade);
  archive.value(beam_energy);
  for (auto* base : {&base_x, &base_y, &base_z}) archive.numbers(*base);
  archive.value(grip_rotation);
  archive.value(grip_turns);
  archive.value(arm_closed);
  archive.value(needle_on_arm);
  archive.value(needle_loaded);
  archive.value(pierced);
  visitBite(archive, pending);
  archive.list(sutures, [&archive](auto& suture) { visitSuture(archive, suture); });
  archive.value(thread_used);
  archive.list(bleedings, [&archive](auto& bleeding) { visitBleeding(archive, bleeding); });
  archive.value(blood_lost);
}

}  // namespace vibe
