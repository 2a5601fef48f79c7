#pragma once

#include "tissue/shell_bending.hpp"
#include "tissue/shell_membrane.hpp"

// The energy of one triangle of a shell and its gradient, for one triangle or a pack of them; law_terms.hpp explains
// why everything is in an unnamed namespace.

namespace vibe {
namespace {

/// The end nodes of a side, and the node opposite it; 0 is node 1.
constexpr int kBeside[3][2] = {{1, 2}, {2, 0}, {0, 1}};

/// Places the ghosts of sides without a neighbour: the opposite node is reflected at the midpoint of the side. The
/// metric of the membrane there is that of the triangle itself.
template <class B, class Rest>
[[gnu::always_inline]] inline void placeGhosts(const Rest& rest, Patch<B>& u) {
  const B one = constant<B>(1), zero = constant<B>(0);
  for (int side = 0; side < 3; ++side) {
    const int p = kBeside[side][0], q = kBeside[side][1];
    const B real = rest(kShellGhost + 4 * side);
    for (int r = 0; r < 3; ++r) {
      const B sum = (p == 0 ? zero : u[p - 1][r]) + (q == 0 ? zero : u[q - 1][r]);
      const B ghost = sum - (side == 0 ? zero : u[side - 1][r]);
      u[side + 2][r] = mulAdd(real, u[side + 2][r], B((one - real) * ghost));
    }
  }
}

/// For bending, moves the ghosts across clamped sides along the normal, like the opposite node: the tangent plane
/// stays. The membrane does not see this: a mesh that does not resolve how the slope grows from 0 would lose its
/// stretch there.
template <class B, class Rest>
[[gnu::always_inline]] inline void clampGhosts(const Rest& rest, Patch<B>& u) {
  const B half = constant<B>(0.5), zero = constant<B>(0);
  for (int side = 0; side < 3; ++side) {
    const int row = kShellGhost + 4 * side, p = kBeside[side][0], q = kBeside[side][1];
    const B m[3] = {rest(row + 1), rest(row + 2), rest(row + 3)};
    B arm[3];
    for (int r = 0; r < 3; ++r) {
      const B sum = (p == 0 ? zero : u[p - 1][r]) + (q == 0 ? zero : u[q - 1][r]);
      arm[r] = (side == 0 ? zero : u[side - 1][r]) - half * sum;
    }
    const B along = dot(m, arm);
    for (int r = 0; r < 3; ++r) u[side + 2][r] = mulAdd(m[r], along, u[side + 2][r]);
  }
}

/// The transpose of clampGhosts.
template <class B, class Rest>
[[gnu::always_inline]] inline void returnClamped(const Rest& rest, Patch<B>& f) {
  const B half = constant<B>(0.5);
  for (int side = 0; side < 3; ++side) {
    const int row = kShellGhost + 4 * side, p = kBeside[side][0], q = kBeside[side][1];
    const B m[3] = {rest(row + 1), rest(row + 2), rest(row + 3)};
    const B along = dot(m, f[side + 2]);
    for (int r = 0; r < 3; ++r) {
      const B beside = B(half * along) * m[r];
      if (p != 0) f[p - 1][r] = f[p - 1][r] - beside;
      if (q != 0) f[q - 1][r] = f[q - 1][r] - beside;
      if (side != 0) f[side - 1][r] = mulAdd(along, m[r], f[side - 1][r]);
    }
  }
}

/// The transpose of placeGhosts.
template <class B, class Rest>
[[gnu::always_inline]] inline void returnGhosts(const Rest& rest, Patch<B>& f) {
  for (int side = 0; side < 3; ++side) {
    const int p = kBeside[side][0], q = kBeside[side][1];
    const B real = rest(kShellGhost + 4 * side);
    for (int r = 0; r < 3; ++r) {
      const B own = real * f[side + 2][r], ghost = f[side + 2][r] - own;
      f[side + 2][r] = own;
      if (p != 0) f[p - 1][r] = f[p - 1][r] + ghost;
      if (q != 0) f[q - 1][r] = f[q - 1][r] + ghost;
      if (side != 0) f[side - 1][r] = f[side - 1][r] - ghost;
    }
  }
}

/// Half of what `membrane` returns and what `bending` returns. Both have x, u and f as arguments and add a gradient to
/// f.
/// @param u  with ghosts as placeGhosts leaves them
template <bool ghosts, class B, class Rest, class Membrane, class Bending>
[[gnu::always_inline]] inline B membraneAndBending(const Rest& rest, const Membrane& membrane_part,
                                                   const Bending& bending_part, Patch<B>& u, Patch<B>& f) {
  Patch<B> x;
  for (int a = 0; a < 5; ++a)
    for (int r = 0; r < 3; ++r) x[a][r] = rest(kShellPatch + 3 * a + r), f[a][r] = constant<B>(0);
  const B membrane = membrane_part(x, u, f);
  if constexpr (!ghosts) {
    return mulAdd(constant<B>(0.5), membrane, bending_part(x, u, f));
  } else {
    B kept[3][3];
    for (int side = 0; side < 3; ++side)
      for (int r = 0; r < 3; ++r) kept[side][r] = f[side + 2][r], f[side + 2][r] = constant<B>(0);
    clampGhosts(rest, u);
    const B bending = bending_part(x, u, f);
    returnClamped(rest, f);
    for (int side = 0; side < 3; ++side)
      for (int r = 0; r < 3; ++r) f[side + 2][r] = f[side + 2][r] + kept[side][r];
    return mulAdd(constant<B>(0.5), membrane, bending);
  }
}

/// Energy of a triangle. Its gradient with respect to nodes 2 to 6 is written to f; that of node 1 is minus their sum.
/// @tparam rows        of the triangle
/// @param contraction  of its muscle, see shorten(); unused without
/// @param beside       a constant stress that acts as well, as shellStress() gives it
/// @param u            with ghosts as placeGhosts leaves them
/// @param work         out: of the constant stress from rest to here
template <Law law, int Steps, int rows, class B, class Rest, class Stress>
[[gnu::always_inline]] inline B shellEnergy(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                            const Stress& beside, Patch<B>& u, Patch<B>& f, B& work) {
  B twice_work = constant<B>(0), bending_work = constant<B>(0);
  const auto membrane = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    return membraneEnergy<law, Steps, rows>(terms, rest, contraction, beside, x, at, to, twice_work);
  };
  const auto bending = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    return bendingEnergy(terms, rest, beside, x, at, to, bending_work);
  };
  const B energy = membraneAndBending<rows == kShellGhostRows>(rest, membrane, bending, u, f);
  work = mulAdd(constant<B>(0.5), twice_work, bending_work);
  return energy;
}

/// The energy of a triangle.
/// @param out     its stress and its moments, kStressRows numbers in order
/// @param strain  with each of which these work
template <Law law, int Steps, int rows, class B, class Rest>
[[gnu::always_inline]] inline B shellStress(const WallTerms<B>& terms, const Rest& rest, const B& contraction,
                                            Patch<B>& u, B (&out)[kStressRows], B (&strain)[kStressRows]) {
  const B half = constant<B>(0.5);
  const auto membrane = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
        __attribute__((always_inline)) {
      B a[3], change[3];
      const B twice = sideStress<law, Steps, rows>(terms, rest, contraction, k, e, d, ue, ud, a);
      metricChange(e, d, ue, ud, change);
      for (int c = 0; c < 3; ++c) out[3 * k + c] = a[c], strain[3 * k + c] = c == 1 ? change[c] : half * change[c];
      for (int r = 0; r < 3; ++r) fe[r] = fd[r] = constant<B>(0);
      return twice;
    };
    return overSides(side, x, at, to);
  };
  const auto bending = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>&) __attribute__((always_inline)) {
    const Bent<B> surface = bentSurface(rest, x, at);
    const Moments<B> bent = momentsOf(terms, rest, surface);
    for (int c = 0; c < 3; ++c) out[9 + c] = bent.m[c], strain[9 + c] = surface.change[c];
    return bent.energy();
  };
  Patch<B> unused;
  return membraneAndBending<rows == kShellGhostRows>(rest, membrane, bending, u, unused);
}

/// The work of a stress that shellStress() has given, from rest to here; its gradient is written to f.
/// @param stress  a number of it, by its row
template <bool ghosts, class B, class Rest, class Stress>
[[gnu::always_inline]] inline B shellStressWork(const Rest& rest, const Stress& stress, Patch<B>& u, Patch<B>& f) {
  const auto membrane = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    const auto side = [&](int k, const B(&e)[3], const B(&d)[3], const B(&ue)[3], const B(&ud)[3], B(&fe)[3], B(&fd)[3])
        __attribute__((always_inline)) {
      const B a[3] = {stress(3 * k), stress(3 * k + 1), stress(3 * k + 2)};
      stressForces(a, e, d, ue, ud, fe, fd);
      return stressWork(a, e, d, ue, ud);
    };
    return overSides(side, x, at, to);
  };
  const auto bending = [&](const Patch<B>& x, const Patch<B>& at, Patch<B>& to) __attribute__((always_inline)) {
    const B m[3] = {stress(9), stress(10), stress(11)};
    return momentWork(m, rest, x, at, to);
  };
  return membraneAndBending<ghosts>(rest, membrane, bending, u, f);
}

/// A third of the area vector of a triangle (a sixth of the cross product), the share of each node; returns the volume
/// of the cone to the origin.
template <class B, class Rest>
[[gnu::always_inline]] inline B coneVolume(const Rest& rest, const Patch<B>& u, const B (&u1)[3], B (&share)[3]) {
  const B sixth = constant<B>(1.0 / 6);
  B e[3], d[3], at[3];
  for (int r = 0; r < 3; ++r) {
    e[r] = rest(kShellPatch + r) + u[0][r], d[r] = rest(kShellPatch + 3 + r) + u[1][r];
    at[r] = rest(kShellOrigin + r) + u1[r];
  }
  cross(e, d, share);
  for (int r = 0; r < 3; ++r) share[r] = sixth * share[r];
  return dot(at, share);
}

}  // namespace
}  // namespace vibe
