#pragma once
#include <pybind11/pybind11.h>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe::python {

/// The input that keywords make of another one: joints and buttons by their names, or `joints`, `buttons` and `pull`.
/// @param model  has the particles, of which one can be pulled, and the breath, which can be held if there is one
/// @throws Error for a word that is none of them, and for a value of a wrong shape, that is not finite, or that the
/// model
///         cannot use
StepInput changedInput(StepInput input, const pybind11::kwargs& keywords, const Model& model);

/// As a dictionary that step() takes as keywords.
pybind11::dict asKeywords(const StepInput& input);

/// The keywords, for docstrings.
extern const char* const kInputHelp;

}  // namespace vibe::python
