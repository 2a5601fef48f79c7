#pragma once

#include <functional>
#include <memory>
#include <string>

namespace vibe {

struct Model;
struct State;
struct Suture;

/// How a cinched set draws the wall together, where it is not by its thread (suture.cinch_model). This says what the
/// cinch does to a set; how the set then pulls on the tissue says a constraint (constraint_registry.hpp), which is
/// asked in every step. Constant: what has to last is in Suture, the particles of a set in Suture::group.
class CinchModel {
 public:
  virtual ~CinchModel() = default;
  /// The cinch of a set begins.
  virtual void begin(const Model& model, const State& state, Suture& suture) const = 0;
  /// The cinch draws, at most by an amount, and adds what it drew to Suture::pulled. Called in every step of a cinch
  /// until the set has its tension.
  /// @return what was drawn [m]
  virtual double draw(const Model& model, const State& state, double amount, Suture& suture) const = 0;
  /// The tissue was put back to rest, and the set must not pull it away again.
  virtual void slacken(const State& state, Suture& suture) const = 0;
};

/// Makes a model known under a word of suture.cinch_model, for the rest of the program. Call it before the scene is
/// read. Safe to call from any thread.
/// @param meaning  one line for people
/// @throws Error if the word is not usable, see addChoice(), or there is no model
void registerCinchModel(const std::string& name, const std::string& meaning, std::shared_ptr<const CinchModel> model);

/// The model of that word; null for `thread`. @throws Error for a word that is not known
std::shared_ptr<const CinchModel> findCinchModel(const std::string& name);

struct Model;
struct State;
struct StepReport;
class ToolMotion;

/// What moves the wall in the place of the tissue solver, or together with it, in a scene whose argon beam is to deform
/// the wall in a way of its own (marking.deformation). Scratch memory of one simulation: what has to last is in State,
/// for example in ProcedureState::base_x.
class MarkingDeformation {
 public:
  virtual ~MarkingDeformation() = default;
  /// One step of the tissue, in every step of the scene.
  /// @param pedal  of the argon beam is down
  /// @param solve  a step of the tissue solver; call it once or not at all
  virtual void advance(const ToolMotion& motion, bool pedal, const std::function<void()>& solve, State& state,
                       StepReport& report) = 0;
};

/// @param model  with a tool; outlives what is made
using MarkingDeformationFactory = std::function<std::unique_ptr<MarkingDeformation>(const Model& model)>;

/// Makes a way of deformation known under a word of marking.deformation, for the rest of the program. Call it before
/// the scene is read. Safe to call from any thread.
/// @param meaning  one line for people
/// @throws Error if the word is not usable, see addChoice(), or the factory is empty
void registerMarkingDeformation(const std::string& name, const std::string& meaning, MarkingDeformationFactory factory);

/// What scene.marking->deformation names; null for `solver`. @throws Error for a word that is not known
std::unique_ptr<MarkingDeformation> makeMarkingDeformation(const Model& model);

}  // namespace vibe
