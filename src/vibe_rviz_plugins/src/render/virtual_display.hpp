#pragma once
namespace vibe {

/// Sees to it that this process has an X display to draw on. Where DISPLAY names none that answers, it starts an Xvfb
/// of its own, which draws without a graphics card and ends when this process does, whatever ends it.
/// @throws std::runtime_error  there is no display and no Xvfb, in one sentence
void provideDisplay();

}  // namespace vibe
