#include "protocol/topology_message.hpp"

#include <numeric>

#include "protocol/byte_writer.hpp"

namespace vibe::web {

Bytes encodeTopology(const graphics::TissueMesh& mesh, const graphics::MucosaMap& map) {
  std::vector<std::uint32_t> offsets = mesh.render_offsets, particles = mesh.render_particles;
  std::vector<float> weights = mesh.render_weights;
  if (!mesh.subdivided()) {
    offsets.resize(mesh.vertex_count + 1);
    std::iota(offsets.begin(), offsets.end(), 0U);
    particles.assign(offsets.begin(), offsets.end() - 1);
    weights.assign(mesh.vertex_count, 1);
  }
  ByteWriter writer(Kind::Topology, 28 + 4 * (mesh.particle_triangles.size() + mesh.triangles.size() + offsets.size() +
                                              2 * weights.size() + mesh.rest.size() + 8 * map.of_vertex.size()));
  for (int k = 0; k < 3; ++k) writer.put(std::uint8_t{0});
  for (const std::size_t count : {std::size_t{mesh.revision}, mesh.particle_count, mesh.vertex_count,
                                  mesh.particle_triangles.size() / 3, mesh.triangles.size() / 3, weights.size()})
    writer.put(static_cast<std::uint32_t>(count));
  writer.putAll(mesh.particle_triangles.data(), mesh.particle_triangles.size());
  writer.putAll(mesh.triangles.data(), mesh.triangles.size());
  writer.putAll(offsets.data(), offsets.size());
  writer.putAll(particles.data(), particles.size());
  writer.putAll(weights.data(), weights.size());
  writer.putAll(mesh.rest.data(), mesh.rest.size());
  for (const graphics::MucosaVertex& vertex : map.of_vertex) {
    writer.putAll(vertex.around, 2);
    for (const float number :
         {vertex.bend, vertex.broad, vertex.folded, vertex.antral, vertex.beyond_z, vertex.beyond_ring})
      writer.put(number);
  }
  return writer.take();
}

}  // namespace vibe::web
