#include "vibe_core/tissue/material_registry.hpp"

#include <cmath>
#include <deque>
#include <mutex>
#include <sstream>

#include "tissue/law_terms.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/scene/choices.hpp"
#include "vibe_core/scene/nearest_key.hpp"

namespace vibe {
namespace {

constexpr const char* kKey = "tissue.law";

/// In the order of their numbers, from kLawCount. Laws are never removed, because materials refer to them.
struct RegisteredLaws {
  std::mutex mutex;
  std::deque<std::shared_ptr<const MaterialLaw>> laws;
};

RegisteredLaws& registeredLaws() {
  static RegisteredLaws laws;
  return laws;
}

/// Checks a law before its registration, with test parameters.
class LawCheck {
 public:
  LawCheck(const std::string& name, const MaterialLaw& law) : name_(name), law_(law) {}

  void run() const {
    const LawDerivatives rest = at(0, 0);
    expect("the energy at rest", rest.energy, 0);
    expect("W_J + 2 W_I at rest", rest.by_j + 2 * rest.by_i, 0);
    expect("2 W_I at rest", 2 * rest.by_i, kParameters.shear);
    expect("4 W_II + 4 W_IJ + W_JJ - 2 W_I at rest", 4 * rest.by_ii + 4 * rest.by_ij + rest.by_jj - 2 * rest.by_i,
           kParameters.lambda);
    checkDerivatives(0.6, 0.1);
    checkDerivatives(0.4, -0.2);
    for (const double volume : {-0.999, -1.0, -1.5, -9.0}) checkFinite(0.5, volume);
  }

 private:
  static constexpr LawParameters kParameters{1.0, 2.0, 0.7};

  const std::string& name_;
  const MaterialLaw& law_;

  LawDerivatives at(double i, double j) const { return law_.at(kParameters, {i, j, i - 2 * j}); }

  void expect(const std::string& what, double value, double expected, double tolerance = 1e-9) const {
    if (std::abs(value - expected) <= tolerance) return;
    std::ostringstream message;
    message << "material law '" << name_ << "': " << what << " is " << value << ", but must be " << expected
            << " (mu = 1, lambda = 2, stiffening = 0.7); correct the law";
    throw Error(message.str());
  }

  void checkDerivatives(double i, double j) const {
    const double h = 1e-5;
    const LawDerivatives w = at(i, j);
    const LawDerivatives i1 = at(i + h, j), i0 = at(i - h, j), j1 = at(i, j + h), j0 = at(i, j - h);
    const double size = std::abs(w.energy) + std::abs(w.by_i) + std::abs(w.by_j) + std::abs(w.by_ii) +
                        std::abs(w.by_ij) + std::abs(w.by_jj);
    std::ostringstream place;
    place << " at I - 3 = " << i << ", J - 1 = " << j << " against differences";
    expect("W_I" + place.str(), w.by_i, (i1.energy - i0.energy) / (2 * h), 1e-6 * size);
    expect("W_J" + place.str(), w.by_j, (j1.energy - j0.energy) / (2 * h), 1e-6 * size);
    expect("W_II" + place.str(), w.by_ii, (i1.by_i - i0.by_i) / (2 * h), 1e-6 * size);
    expect("W_IJ" + place.str(), w.by_ij, (j1.by_i - j0.by_i) / (2 * h), 1e-6 * size);
    expect("W_JJ" + place.str(), w.by_jj, (j1.by_j - j0.by_j) / (2 * h), 1e-6 * size);
  }

  void checkFinite(double i, double j) const {
    const LawDerivatives w = at(i, j);
    for (const double value : {w.energy, w.by_i, w.by_j, w.by_ii, w.by_ij, w.by_jj}) {
      if (std::isfinite(value)) continue;
      std::ostringstream message;
      message << "material law '" << name_ << "': has no finite value at J = " << 1 + j
              << ", but a wall may be inverted; continue the formula there";
      throw Error(message.str());
    }
  }
};

}  // namespace

Law registerMaterialLaw(const std::string& name, std::shared_ptr<const MaterialLaw> law) {
  if (!law) throw Error("material law '" + name + "': there is no object; pass one");
  LawCheck(name, *law).run();
  RegisteredLaws& all = registeredLaws();
  const std::lock_guard<std::mutex> lock(all.mutex);
  addChoice(kKey, {name, law->formula()});
  all.laws.push_back(std::move(law));
  return static_cast<Law>(kLawCount + static_cast<int>(all.laws.size()) - 1);
}

const MaterialLaw* registeredLaw(Law law) {
  RegisteredLaws& all = registeredLaws();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const int number = static_cast<int>(law) - kLawCount;
  if (number < 0 || number >= static_cast<int>(all.laws.size())) return nullptr;
  return all.laws[static_cast<std::size_t>(number)].get();
}

LawDerivatives registeredLawAt(const LawConstants& constants, const LawInvariants& deformation) {
  return constants.registered->at({constants.shear, constants.bulk, constants.stiffening}, deformation);
}

// The names in tissue.law are in the order of the numbers: those of the list, then the registered ones.
Law lawByName(const std::string& name) {
  std::vector<std::string> words;
  for (const Choice& choice : choicesOf(kKey)) {
    if (choice.word == name) return static_cast<Law>(words.size());
    words.push_back(choice.word);
  }
  throw Error(std::string(kKey) + " '" + name + "' is unknown; " + suggestKey(name, words));
}

std::string nameOf(Law law) {
  return choicesOf(kKey).at(static_cast<std::size_t>(law)).word;
}

}  // namespace vibe
