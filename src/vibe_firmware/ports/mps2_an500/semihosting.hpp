#pragma once
#include <cstddef>

// Calls to the emulator that runs the image; ARM's semihosting specification, version 3.0. Virtual time stands still
// during a call.

namespace vibe_firmware::semihosting {

/// Ends the emulation with this exit status.
[[noreturn]] void exit(int status);

enum class Mode : int { Read = 1, Write = 5 };

/// Opens a file or FIFO of the host; waits until the other end of a FIFO is open. @return handle; negative: failed
int open(const char* name, Mode mode);

/// @return false: not every byte could be written
bool write(int handle, const void* bytes, std::size_t size);

/// Waits for all bytes. @return false: the other end has closed
bool read(int handle, void* bytes, std::size_t size);

/// Copies the command line of the image (option `arg` of -semihosting-config). @return false: there is none
bool commandLine(char* text, std::size_t capacity);

}  // namespace vibe_firmware::semihosting
