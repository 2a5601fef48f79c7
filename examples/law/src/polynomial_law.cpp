#include <memory>

#include "vibe_core/tissue/material_registry.hpp"

namespace {

/// W = mu/2 (K + b/2 K^2) + lambda/2 (J - 1)^2 with K = I + J^2 - 4 J. K is 0 at rest and positive elsewhere (the mean
/// of l1^2, l2^2, l3^2, J^2 is at least that of geometry), and W is a polynomial: finite for inverted material too.
class PolynomialLaw : public vibe::MaterialLaw {
 public:
  std::string formula() const override {
    return "mu/2 (K + b/2 K^2) + lambda/2 (J - 1)^2; here K = I + J^2 - 4 J (example of another package)";
  }

  vibe::LawDerivatives at(const vibe::LawParameters& p, const vibe::LawInvariants& x) const override {
    const double mu = p.shear, b = p.stiffening, v = x.volume;
    const double k = x.difference + v * v;
    const double slope = 1 + b * k;
    vibe::LawDerivatives w;
    w.energy = mu / 2 * (k + b / 2 * k * k) + p.lambda / 2 * v * v;
    w.by_i = mu / 2 * slope;
    w.by_j = mu * slope * (v - 1) + p.lambda * v;
    w.by_ii = mu / 2 * b;
    w.by_ij = mu * b * (v - 1);
    w.by_jj = 2 * mu * b * (v - 1) * (v - 1) + mu * slope + p.lambda;
    return w;
  }
};

// Scenes may write `tissue: {law: polynomial}` in every program that loads this library.
const vibe::Law kPolynomial = vibe::registerMaterialLaw("polynomial", std::make_shared<PolynomialLaw>());

}  // namespace
