#pragma once
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

}  // namespace vibe
