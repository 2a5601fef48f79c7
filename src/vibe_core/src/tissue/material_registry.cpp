#include "vibe_core/tissue/material_registry.hpp"

#include <cmath>
#include <deque>
#include <mutex>
#include <sstream>

#include "tissue/law_terms.hpp"
#include "tissue/material_law.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe {

namespace {

LawLimits limitsOf(Law law) {
  if (const MaterialLaw* registered = registeredLaw(law)) return registered->limits();
  return withLaw(law, [](auto tag) { return LawFormula<decltype(tag)::value>::kLimits; });
}

/// Names of the laws with the given value of a flag in their limits.
std::string lawsWith(bool LawLimits::*flag, bool set) {
  std::string names;
  for (int k = 0; k < kLawCount; ++k) {
    const Law law = static_cast<Law>(k);
    if (limitsOf(law).*flag == set) names += (names.empty() ? "" : ", ") + nameOf(law);
  }
  return names;
}

[[noreturn]] void reject(const std::string& place, const char* name, double value, const std::string& range) {
  std::ostringstream message;
  message << place << ": " << name << " is " << value << ", but must be " << range << '.';
  throw Error(message.str());
}

}  // namespace

void checkMaterial(const Material& material, const std::string& place) {
  const double e = material.young_modulus, nu = material.poisson_ratio, b = material.stiffening;
  if (static_cast<int>(material.law) >= kLawCount && registeredLaw(material.law) == nullptr)
    throw Error(place + ": the law has a number that no law has; use lawByName() or registerMaterialLaw().");
  const LawLimits limits = limitsOf(material.law);
  if (!(e > 0) || !std::isfinite(e)) reject(place, "Young's modulus", e, "a finite number above 0 Pa");
  if (!(nu > -1 && nu < 0.5)) reject(place, "Poisson's ratio", nu, "above -1 and below 0.5");
  if (nu < 0 && !limits.negative_poisson_ratio)
    reject(place, "Poisson's ratio", nu,
           "0 or more for this law (allowed below 0: " + lawsWith(&LawLimits::negative_poisson_ratio, true) + ")");
  if (!(b >= 0) || !std::isfinite(b)) reject(place, "the stiffening", b, "a finite number, 0 or more");
  if (b == 0 && limits.needs_stiffening)
    reject(place, "the stiffening", b, "above 0 for the law " + nameOf(material.law) + " (neo_hookean is without it)");
}

LawConstants lawConstants(const Material& material) {
  checkMaterial(material, "the material");
  const double nu = material.poisson_ratio;
  const double mu = material.young_modulus / (2 * (1 + nu));
  const double lambda = 2 * mu * nu / (1 - 2 * nu);
  return withLaw(material.law, [&](auto tag) {
    using Formula = LawFormula<decltype(tag)::value>;
    LawConstants constants = Formula::constants(mu, lambda, material.stiffening, Formula::kLimit);
    constants.registered = registeredLaw(material.law);
    return constants;
  });
}

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

MaterialEnergy::MaterialEnergy(const Material& material)
    : law_(material.law), constants_(std::make_shared<const LawConstants>(lawConstants(material))) {}

EnergyDerivatives<double> MaterialEnergy::at(double first, double volume, double difference) const {
  const LawTerms<double> terms(*constants_);
  const auto w = withLaw(law_, [&](auto tag) { return lawAt<decltype(tag)::value>(terms, first, volume, difference); });
  return {w.energy, w.by_i, w.by_j, w.balance, w.by_ii, w.by_ij, w.by_jj};
}

EnergyDerivatives<float> MaterialEnergy::at(float first, float volume, float difference) const {
  const LawTerms<FusedFloats> terms(*constants_);
  const FusedFloats i(first), j(volume), even(difference);
  const auto w = withLaw(law_, [&](auto tag) { return lawAt<decltype(tag)::value>(terms, i, j, even); });
  return {w.energy.get(0), w.by_i.get(0),  w.by_j.get(0), w.balance.get(0),
          w.by_ii.get(0),  w.by_ij.get(0), w.by_jj.get(0)};
}

}  // namespace vibe
