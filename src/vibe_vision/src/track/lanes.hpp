#pragma once

/// Before a function whose loops the compiler turns into vector instructions: made a second time for processors with
/// AVX2, chosen when the program starts. The results are the same bits.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define VIBE_LANES [[gnu::target_clones("avx2", "default")]]
#else
#define VIBE_LANES
#endif
