#pragma once

#include "tissue/law_formulas.hpp"

// A law of the list, selected by number, for a scalar or a pack of scalars; law_terms.hpp explains why everything is in
// an unnamed namespace.

namespace vibe {
namespace {

/// The part of the energy that depends only on K = I - 3 - 2 ln J.
template <Law law, class B>
inline Profile<B> profile(const LawTerms<B>& c, const B& k) {
  const B half_shear = constant<B>(0.5) * c.shear, zero = constant<B>(0);
  if constexpr (LawFormula<law>::kConstantSlope) {
    return {half_shear * k, half_shear, zero, zero};
  } else {
    const B inside = smaller(k, c.limit), beyond = k - inside, x = c.stiffening * inside;
    const auto [value, first, second, third] = LawFormula<law>::profile(c, inside, x);
    const B bend = second * beyond;
    return {half_shear * mulAdd(beyond, mulAdd(constant<B>(0.5), bend, first), value), half_shear * (first + bend),
            half_shear * second, choose(k < c.limit, B(half_shear * third), zero)};
  }
}

/// @param i     I - 3
/// @param j     J - 1
/// @param even  i - 2 j, of second order in the strain. It is a separate argument because the energy near rest depends
///         on it: a caller that has the displacement gradient H computes it without cancellation as i - 2 j = H:H - 2
///         m(H) - 2 det H, where m is the sum of the principal 2 x 2 minors. Otherwise pass i - 2 j.
/// After inlining, results that the caller does not use are not computed.
template <Law law, class B>
[[gnu::always_inline]] inline LawAt<B> lawAt(const LawTerms<B>& c, const B& i, const B& j, const B& even) {
  const B half = constant<B>(0.5), two = constant<B>(2);
  LawAt<B> out;
  if constexpr (LawFormula<law>::kLogVolume) {
    const LogVolume<B> l = logVolume(j);
    const Profile<B> p = profile<law>(c, B(mulAdd(two, l.gap, even)));
    const B pull = c.bulk * l.value;
    out.energy = mulAdd(half * pull, l.value, p.value);
    out.by_i = p.first;
    out.balance = mulAdd(two * p.first, l.defect, pull * l.slope);
    out.by_ii = p.second;
    out.by_ij = -two * l.slope * p.second;
    out.by_jj = l.slope * l.slope * (constant<B>(4) * p.second + c.bulk) + l.curvature * (pull - two * p.first);
  } else {
    out = LawFormula<law>::at(c, i, j, even);
  }
  out.by_j = out.balance - two * out.by_i;
  return out;
}

template <Law law>
struct LawTag {
  static constexpr Law value = law;
};

/// Calls visit(LawTag<law>()) for a law known at run time; every registered law has the tag kRegisteredLaw.
template <class Visitor>
inline auto withLaw(Law law, const Visitor& visit) {
  switch (law) {
#define VIBE_VISIT(name, word, formula) \
  case Law::name:                       \
    return visit(LawTag<Law::name>());
    VIBE_MATERIAL_LAWS(VIBE_VISIT)
#undef VIBE_VISIT
  }
  return visit(LawTag<kRegisteredLaw>());
}

}  // namespace
}  // namespace vibe
