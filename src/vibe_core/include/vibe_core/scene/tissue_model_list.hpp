#pragma once

/// The tissue models of the library, the one list of them: MODEL(name, word of tissue.model, meaning). A model is one
/// line here and the factory make<Name>() that builder/tissue_registry.cpp calls; without it the library does not
/// compile. Models of other packages are registered at run time: see builder/tissue_registry.hpp.
#define VIBE_TISSUE_MODELS(MODEL)                                                                                  \
  MODEL(Shell, shell, "triangles that stretch and bend; implicit time stepping; its error is known (accuracy.md)") \
  MODEL(ShapeMatching, shape_matching, "clusters of particles (shape matching), the method of the ViBE prototype")
