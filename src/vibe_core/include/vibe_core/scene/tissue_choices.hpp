#pragma once

/// The tissue models of the library, the one list of them: MODEL(name, word of tissue.model, meaning). A model is one
/// line here and the factory make<Name>() that builder/tissue_registry.cpp calls; without it the library does not
/// compile. Models of other packages are registered at run time: see builder/tissue_registry.hpp.
#define VIBE_TISSUE_MODELS(MODEL)                                                                                  \
  MODEL(Shell, shell, "triangles that stretch and bend; implicit time stepping; its error is known (accuracy.md)") \
  MODEL(ShapeMatching, shape_matching, "clusters of particles (shape matching), the method of the ViBE prototype")

/// The elastic laws of the library, the one list of them: LAW(name of the enum, word of tissue.law, formula).
/// It gives `enum class Law`, the words of scene files and benchmark cases, the documentation, and the dispatch to the
/// kernels. A law is one line here and the specialisation of LawFormula of the same name in tissue/law_formulas.hpp.
/// Laws of other packages are registered at run time: see tissue/material_registry.hpp.
#define VIBE_MATERIAL_LAWS(LAW)                                                                                      \
  LAW(NeoHookean, neo_hookean, "mu/2 (I - 3) - mu ln J + lambda/2 (ln J)^2")                                         \
  LAW(StableNeoHookean, stable_neo_hookean,                                                                          \
      "ms/2 (I - 3) + ls/2 (J - a)^2 - ms/2 ln(I + 1); ms = 4/3 mu, ls = lambda + 5/6 mu, a = 1 + 3/4 ms/ls "        \
      "(Smith, de Goes, Kim 2018, with the barrier term)")                                                           \
  LAW(MacklinMueller, macklin_mueller,                                                                               \
      "mu/2 (I - 3) + lm/2 (J - g)^2; lm = lambda + mu, g = 1 + mu/lm (Macklin, Mueller 2021)")                      \
  LAW(Fung, fung, "mu/2 (exp(b K) - 1)/b + lambda/2 (ln J)^2; b > 0 (Fung 1967, in the invariants)")                 \
  LAW(Gent, gent, "-mu/2 Jm ln(1 - K/Jm) + lambda/2 (ln J)^2; Jm = 1/b, b > 0 (Gent 1996)")                          \
  LAW(Yeoh, yeoh,                                                                                                    \
      "mu/2 (K + b/2 K^2 + b^2/6 K^3) + lambda/2 (ln J)^2: the first terms of fung, finite for every stretch (Yeoh " \
      "1993)")
