#include "method/bullet_wall.hpp"

#include <BulletSoftBody/btSoftBody.h>

#include <cmath>

namespace vibe::benchmarks {
namespace {

constexpr double kSettlingDamping = 10;  // damping until the inflated start is reached [1/s]

btVector3 toBullet(const Eigen::Vector3d& p) {
  return {static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()), static_cast<btScalar>(p.z())};
}

std::unique_ptr<btSoftBody> makeSoftBody(const BenchWall& wall, btSoftBodyWorldInfo& world, int iterations) {
  std::vector<btVector3> nodes;
  std::vector<btScalar> mass;
  for (const auto& p : wall.mesh.vertices) nodes.push_back(toBullet(p));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    mass.push_back(wall.body.fixed[n] != 0 ? btScalar(0) : static_cast<btScalar>(wall.body.mass[n]));
  auto body = std::make_unique<btSoftBody>(&world, static_cast<int>(nodes.size()), nodes.data(), mass.data());
  for (const auto& t : wall.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!body->checkLink(t[k], t[(k + 1) % 3])) body->appendLink(t[k], t[(k + 1) % 3]);
    body->appendFace(t[0], t[1], t[2]);
  }
  body->m_materials[0]->m_kLST = 1;
  body->generateBendingConstraints(2);
  body->m_cfg.piterations = iterations;
  body->m_cfg.kPR = static_cast<btScalar>(wall.pressure * wall.rest_volume);
  body->updateConstants();  // the current lengths become rest lengths
  return body;
}

void advance(const BenchWall& wall, double step, double mass_damping, btSoftBody& body) {
  // Bullet divides kPR by the volume
  body.m_cfg.kPR = static_cast<btScalar>(wall.pressure) * body.getVolume();
  body.m_cfg.kDP = static_cast<btScalar>(1 - std::exp(-mass_damping * step));
  body.predictMotion(static_cast<btScalar>(step));
  body.solveConstraints();
  body.integrateMotion();
}

BodyMotion read(const BenchWall& wall, const btSoftBody& body) {
  BodyMotion motion(wall.body);
  for (int n = 0; n < body.m_nodes.size(); ++n)
    for (int k = 0; k < 3; ++k) {
      motion.x[static_cast<std::size_t>(k)][n] = static_cast<double>(body.m_nodes[n].m_x[k]);
      motion.v[static_cast<std::size_t>(k)][n] = static_cast<double>(body.m_nodes[n].m_v[k]);
    }
  return motion;
}

}  // namespace

Trajectory runBullet(const BenchWall& wall, const Pull& pull, int steps_per_frame, int iterations) {
  const double step = kFrame / steps_per_frame;
  btSoftBodyWorldInfo world;
  world.m_gravity.setZero();
  world.air_density = 0;
  world.m_sparsesdf.Initialize();
  const auto body = makeSoftBody(wall, world, iterations);
  for (int i = 0; i < 120 * steps_per_frame; ++i) advance(wall, step, kSettlingDamping, *body);
  Trajectory trajectory;
  trajectory.frames.push_back(read(wall, *body));
  std::vector<btVector3> from;
  for (const int n : wall.tool) {
    body->setMass(n, 0);
    body->m_nodes[n].m_v.setZero();
    from.push_back(body->m_nodes[n].m_x);
  }
  const int frames = static_cast<int>(std::lround((pull.duration + pull.hold) / kFrame));
  for (int frame = 1; frame <= frames; ++frame) {
    const double before = threadMilliseconds();
    for (int s = 1; s <= steps_per_frame; ++s) {
      const btVector3 moved = toBullet(wall.pull_direction * pull.at(kFrame * (frame - 1) + step * s));
      for (std::size_t i = 0; i < from.size(); ++i)
        body->m_nodes[wall.tool[i]].m_x = body->m_nodes[wall.tool[i]].m_q = from[i] + moved;
      advance(wall, step, wall.body.mass_damping, *body);
    }
    trajectory.times.push_back(threadMilliseconds() - before);
    trajectory.frames.push_back(read(wall, *body));
    for (const auto& x : trajectory.frames.back().x)
      for (const double value : x) trajectory.finite = trajectory.finite && std::isfinite(value);
  }
  return trajectory;
}

}  // namespace vibe::benchmarks
