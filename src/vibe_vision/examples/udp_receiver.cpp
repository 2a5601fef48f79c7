// Prints where the instruments are now: udp_receiver [port]. Layout: docs/vision.md, "Datagram"; little-endian hosts.
#include <arpa/inet.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

template <class Number>
Number get(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

/// Position in dt seconds: the acceleration goes on, the jerk fades away with the time constant t.
double extrapolate(const char* c, double dt, double t) {
  const double x = dt / t, fade = t * t * t * (1 - x + x * x / 2 - std::exp(-x));
  return get<double>(c) + get<double>(c + 8) * dt + get<double>(c + 16) * dt * dt / 2 + get<double>(c + 24) * fade;
}

int main(int argc, char** argv) {
  const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{AF_INET, htons(static_cast<std::uint16_t>(argc > 1 ? std::atoi(argv[1]) : 9870)), {}, {}};
  if (bind(receiver, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) return std::perror("bind"), 1;
  for (char d[2048]; true; std::fflush(stdout)) {
    const auto size = recv(receiver, d, sizeof d, 0);
    if (size < 40 || std::memcmp(d, "VIBT\1\0", 6) != 0 || size != 40 + 152 * d[6]) continue;
    const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    const double stamp = get<double>(d + 24), dt = std::clamp(now - stamp, 0.0, 0.1), t = get<float>(d + 36);
    for (const char* i = d + 40; i < d + size; i += 152) {  // tracked, reason, has_rotation, ..., slide, rotation
      std::printf("%td %.6f ", (i - d - 40) / 152, stamp + dt);
      if (i[0] == 0) std::printf("lost %d\n", i[1]);
      if (i[0] == 1)
        std::printf(i[2] ? "%.6f %.6f\n" : "%.6f\n", extrapolate(i + 8, dt, t), extrapolate(i + 80, dt, t));
    }
  }
}
