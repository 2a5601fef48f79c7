#pragma once

#include "tissue/shell_point.hpp"

// The fibre energy of one triangle of a shell and its gradient, for one triangle or a pack of them; law_terms.hpp
// explains why everything is in an unnamed namespace.

namespace vibe {
namespace {

// Up to this exponent the law holds; the fibre is then 490 times as stiff as initially. Beyond it the energy is
// extended by a parabola, so that it stays finite in single precision.
constexpr double kFibreLimit = 4;

inline double fibreReach(double stiffening) {
  return std::sqrt(kFibreLimit / stiffening);
}

/// Energy per volume of one family, and its derivatives with respect to the squared stretch.
template <class B>
struct FibreAt {
  B value, first, second;
};

/// @param strain  squared stretch minus 1; fibres do not resist below 0
/// @param reach   fibreReach
template <class B>
[[gnu::always_inline]] inline FibreAt<B> fibreAt(const B& modulus, const B& stiffening, const B& reach,
                                                 const B& strain) {
  const B one = constant<B>(1), half = constant<B>(0.5);
  const B longer = larger(strain, constant<B>(0)), inside = smaller(longer, reach), beyond = longer - inside;
  const B x = stiffening * inside * inside, grown = expMinusOne(x), stiff = modulus * (one + grown);
  FibreAt<B> out;
  out.second = stiff * (one + x + x);
  const B first = stiff * inside;
  out.first = mulAdd(out.second, beyond, first);
  out.value = mulAdd(beyond, B(mulAdd(B(half * out.second), beyond, first)), B(half * modulus * grown / stiffening));
  return out;
}

/// Twice the energy per volume of the fibres at the midpoint of a side, and their stress, see sideStress(), per volume.
template <class B, class Rest, class Fibre>
[[gnu::always_inline]] inline B fibreStress(const B& stiffening, const B& reach, const Rest& rest, const Fibre& fibre,
                                            int side, const B (&e)[3], const B (&d)[3], const B (&ue)[3],
                                            const B (&ud)[3], B (&a)[3]) {
  const int row = kShellSide + 4 * side;
  const B two = constant<B>(2), t[3] = {rest(row), rest(row + 1), rest(row + 2)};
  B s[3], g[3] = {constant<B>(0), constant<B>(0), constant<B>(0)}, energy = constant<B>(0);
  sideStrain(t, e, d, ue, ud, s);
  for (int family = 0; family < 2; ++family) {
    const int at = kFibreSide + 4 * side + 2 * family;
    const B c = fibre(at), n = fibre(at + 1), cc = c * c, cn = c * n, nn = n * n;
    const B strain = mulAdd(cc, s[0], B(mulAdd(B(two * cn), s[1], B(nn * s[2]))));
    const FibreAt<B> w = fibreAt(fibre(kFibreModulus), stiffening, reach, strain);
    energy = energy + w.value;
    g[0] = mulAdd(w.first, cc, g[0]), g[1] = mulAdd(w.first, cn, g[1]), g[2] = mulAdd(w.first, nn, g[2]);
  }
  pushForward(t, g, a);
  return energy;
}

/// Twice the energy of the fibres at the midpoint of a side, and the derivatives with respect to e and d; see
/// sideEnergy.
template <class B, class Rest, class Fibre>
[[gnu::always_inline]] inline B fibreSide(const B& stiffening, const B& reach, const Rest& rest, const Fibre& fibre,
                                          int side, const B (&e)[3], const B (&d)[3], const B (&ue)[3],
                                          const B (&ud)[3], B (&fe)[3], B (&fd)[3]) {
  B a[3];
  const B energy = fibreStress(stiffening, reach, rest, fibre, side, e, d, ue, ud, a);
  const B volume = rest(kShellSide + 4 * side + 3);
  stressForces(a, e, d, ue, ud, fe, fd);
  for (int r = 0; r < 3; ++r) fe[r] = volume * fe[r], fd[r] = volume * fd[r];
  return volume * energy;
}

/// Adds the gradient of the fibres of a triangle to f; returns their energy.
template <class B, class Rest, class Fibre>
[[gnu::always_inline]] inline B fibreEnergy(double stiffening, const Rest& rest, const Fibre& fibre, const Patch<B>& u,
                                            Patch<B>& f) {
  const B b = constant<B>(stiffening), reach = constant<B>(fibreReach(stiffening));
  Patch<B> x;
  for (int a = 0; a < 5; ++a)
    for (int r = 0; r < 3; ++r) x[a][r] = rest(kShellPatch + 3 * a + r);
  const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
      __attribute__((always_inline)) {
    return fibreSide(b, reach, rest, fibre, k, e, d, ue, ud, fe, fd);
  };
  return constant<B>(0.5) * overSides(side, x, u, f);
}

}  // namespace
}  // namespace vibe
