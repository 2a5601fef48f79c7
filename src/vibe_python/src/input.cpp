#include "input.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "arrays.hpp"
#include "vibe_core/constraints/breathing.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::python {

const char* const kInputHelp =
    "Keywords of the input (what is not named stays as it is):\n"
    "  insertion [m], rotation [rad], tip_up_down [rad], tip_left_right [rad], helix_advance [m],\n"
    "  helix_rotation [rad], needle_driver [m]: positions to which the joints are led, within their ranges and speeds\n"
    "  apc_pedal, helix_grab, needle, t_tag, cinch, insufflate: buttons, True while pressed\n"
    "  joints (7,), buttons (6,): all of them, in the order of vibe.JOINTS and vibe.BUTTONS\n"
    "  pull=(particle, target (3,) [m]): the spring that pulls the tissue from outside; None: it lets go\n"
    "  hold_breath: True while the breath is held, in a scene that breathes\n";

namespace {

template <class Names>
int indexOf(const Names& names, const std::string& word) {
  const auto found = std::find(names.begin(), names.end(), word);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::uint8_t pressed(const py::handle& value, const std::string& name) {
  const double found = number(value, name);
  if (found != 0 && found != 1) throw Error("'" + name + "' is a button; give True or False.");
  return found != 0 ? 1 : 0;
}

void setJoints(const py::handle& value, StepInput& input) {
  const auto joints = numbers(value, "joints", {kJointCount});
  std::copy_n(joints.data(), kJointCount, input.joints.begin());
}

void setButtons(const py::handle& value, StepInput& input) {
  const auto buttons = numbers(value, "buttons", {kButtonCount});
  for (int k = 0; k < kButtonCount; ++k) {
    const double found = buttons.data()[k];
    if (found != 0 && found != 1) throw Error("'buttons' holds a value that is neither 0 nor 1; give True or False.");
    input.buttons[static_cast<std::size_t>(k)] = found != 0 ? 1 : 0;
  }
}

void setPull(const py::handle& value, int particles, StepInput& input) {
  input.pull_particle = -1;
  if (value.is_none()) return;
  if (!py::isinstance<py::sequence>(value) || py::len(value) != 2)
    throw Error("'pull' is not a pair; give (particle, target) with the target in metres, or None.");
  const auto pair = py::reinterpret_borrow<py::sequence>(value);
  const double particle = number(pair[0], "pull[0]");
  if (particle < 0 || particle >= particles || particle != static_cast<int>(particle))
    throw Error("'pull[0]' is not the number of a particle; give a whole number from 0 to " +
                std::to_string(particles - 1) + ".");
  input.pull_particle = static_cast<int>(particle);
  input.pull_target = vector3(pair[1], "pull[1]");
}

void setBreath(bool held, const Scene& scene, StepInput& input) {
  const std::string refusal = held ? breathRefusal(scene) : "";
  if (!refusal.empty()) throw Error(refusal);
  input.breath = held ? Breath::Held : Breath::Free;
}

std::string allWords() {
  std::string words;
  for (const char* name : kJointNames) words += std::string(name) + ", ";
  for (const char* name : kButtonNames) words += std::string(name) + ", ";
  return words + "joints, buttons, pull, hold_breath";
}

}  // namespace

StepInput changedInput(StepInput input, const py::kwargs& keywords, const Model& model) {
  for (const auto& [key, value] : keywords) {
    const std::string word = py::cast<std::string>(key);
    const int joint = indexOf(kJointNames, word), button = indexOf(kButtonNames, word);
    if (joint >= 0)
      input.joints[static_cast<std::size_t>(joint)] = number(value, word);
    else if (button >= 0)
      input.buttons[static_cast<std::size_t>(button)] = pressed(value, word);
    else if (word == "joints")
      setJoints(value, input);
    else if (word == "buttons")
      setButtons(value, input);
    else if (word == "pull")
      setPull(value, model.particle_count, input);
    else if (word == "hold_breath")
      setBreath(pressed(value, word) != 0, model.scene, input);
    else
      throw Error("There is no input '" + word + "'; use one of " + allWords() + ".");
  }
  return input;
}

py::dict asKeywords(const StepInput& input) {
  py::dict keywords;
  for (std::size_t k = 0; k < kJointNames.size(); ++k) keywords[kJointNames[k]] = input.joints[k];
  for (std::size_t k = 0; k < kButtonNames.size(); ++k) keywords[kButtonNames[k]] = input.buttons[k] != 0;
  keywords["hold_breath"] = input.breath == Breath::Held;
  keywords["pull"] = py::none();
  if (input.pull_particle >= 0) {
    const Eigen::Vector3d target = input.pull_target;
    keywords["pull"] = py::make_tuple(input.pull_particle, py::make_tuple(target.x(), target.y(), target.z()));
  }
  return keywords;
}

}  // namespace vibe::python
