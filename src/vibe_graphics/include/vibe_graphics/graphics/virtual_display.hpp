#pragma once
namespace vibe::graphics {

/// Makes sure that this process has an X display. If DISPLAY names none that answers, it starts an Xvfb, which draws
/// without a graphics card and ends together with this process, however that ends.
/// @throws std::runtime_error  there is no display and no Xvfb, in one sentence
void provideDisplay();

}  // namespace vibe::graphics
