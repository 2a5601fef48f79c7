#pragma once
#include <pybind11/pybind11.h>

#include "vibe_core/input/step_input.hpp"

namespace vibe::python {

/// The input that keywords make of another one: joints and buttons by their names, or `joints`, `buttons` and `pull`.
/// @param particles  how many the model has, of which one can be pulled
/// @throws Error for a word that is none of them, and for a value of a wrong shape or that is not finite
StepInput changedInput(StepInput input, const pybind11::kwargs& keywords, int particles);

/// As a dictionary that step() takes as keywords.
pybind11::dict asKeywords(const StepInput& input);

/// The keywords, for docstrings.
extern const char* const kInputHelp;

}  // namespace vibe::python
