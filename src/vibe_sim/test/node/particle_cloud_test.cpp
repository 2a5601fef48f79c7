#include "conversions/tissue_message.hpp"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>

#include "conversions/conversions.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::sim::particle_cloud_test {
namespace {

using test::World;

World balloon() {
  return World(test::bareScene(), test::plainOrgan(test::icosphere(0.05, 2), 2e-3));
}

TEST(ParticleCloud, carriesPositionsIdsRegionAndRevision) {
  const World world = balloon();
  ParticleCloud cloud(*world.model, world.state, 3);
  const sensor_msgs::PointCloud2 message = cloud.update(*world.model, world.state, 1'500'000'000);
  EXPECT_EQ(message.header.frame_id, "stomach");
  EXPECT_EQ(message.header.stamp.toSec(), 1.5);
  ASSERT_EQ(message.width, 162u);
  EXPECT_EQ(message.height, 1u);
  EXPECT_EQ(message.data.size(), message.row_step);
  EXPECT_EQ(message.point_step, 28u);
  EXPECT_EQ(message.fields.size(), 7u);
  sensor_msgs::PointCloud2ConstIterator<float> x(message, "x"), z(message, "z");
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> id(message, "id"), revision(message, "revision");
  sensor_msgs::PointCloud2ConstIterator<std::uint8_t> region(message, "region");
  for (std::uint32_t i = 0; i < message.width; ++i, ++x, ++z, ++id, ++revision, ++region) {
    EXPECT_EQ(*x, static_cast<float>(world.state.x[i]));
    EXPECT_EQ(*z, static_cast<float>(world.state.z[i]));
    EXPECT_EQ(*id, i);
    EXPECT_EQ(*revision, 3u);
    EXPECT_EQ(*region, vibe_msgs::TissueTopology::REGION_BODY);
  }
}

TEST(ParticleCloud, carriesMarksWhereThereAreAny) {
  World world = balloon();
  world.state.procedure.dose.assign(162, 0);
  world.state.procedure.grade.assign(162, 0);
  ParticleCloud cloud(*world.model, world.state, 1);
  cloud.update(*world.model, world.state, 1);
  world.state.procedure.dose[100] = 31.5f;
  world.state.procedure.grade[100] = 1;
  const sensor_msgs::PointCloud2 message = cloud.update(*world.model, world.state, 2);
  EXPECT_EQ(message.point_step, 32u);
  EXPECT_EQ(message.data.size(), 32u * 162u);
  sensor_msgs::PointCloud2ConstIterator<float> x(message, "x"), dose(message, "thermal_dose");
  sensor_msgs::PointCloud2ConstIterator<std::uint8_t> grade(message, "grade"), region(message, "region");
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> id(message, "id");
  for (std::uint32_t i = 0; i < message.width; ++i, ++x, ++dose, ++grade, ++region, ++id) {
    EXPECT_EQ(*x, static_cast<float>(world.state.x[i]));
    EXPECT_EQ(*dose, i == 100 ? 31.5f : 0.f);
    EXPECT_EQ(*grade, i == 100 ? 1 : 0);
    EXPECT_EQ(*region, vibe_msgs::TissueTopology::REGION_BODY);
    EXPECT_EQ(*id, i);
  }
}

TEST(ParticleCloud, carriesWhatWasSeenWhereTheSceneAsks) {
  for (const bool marks : {false, true}) {
    World world = balloon();
    if (marks) world.state.procedure.dose.assign(162, 7), world.state.procedure.grade.assign(162, 1);
    Model asked = *world.model;
    asked.scene.inspection.emplace();
    const sensor_msgs::PointCloud2 message = ParticleCloud(asked, world.state, 5).update(asked, world.state, 1);
    EXPECT_EQ(message.point_step, marks ? 36u : 32u);
    sensor_msgs::PointCloud2ConstIterator<float> x(message, "x"), seen(message, "first_seen");
    sensor_msgs::PointCloud2ConstIterator<std::uint32_t> id(message, "id"), revision(message, "revision");
    for (std::uint32_t i = 0; i < message.width; ++i, ++x, ++seen, ++id, ++revision) {
      EXPECT_TRUE(std::isnan(*seen)) << "nobody has looked";
      EXPECT_EQ(*x, static_cast<float>(world.state.x[i]));
      EXPECT_EQ(*id, i);
      EXPECT_EQ(*revision, 5u);
    }
    const sensor_msgs::PointCloud2 plain =
        ParticleCloud(*world.model, world.state, 1).update(*world.model, world.state, 1);
    EXPECT_EQ(plain.fields.size() + 1, message.fields.size()) << "control";
  }
}

TEST(ParticleCloud, strainOfAnEvenExpansionIsItsFactorMinusOne) {
  World world = balloon();
  ParticleCloud cloud(*world.model, world.state, 1);
  for (auto* axis : {&world.state.x, &world.state.y, &world.state.z}) {
    for (double& value : *axis) value *= 1.03;
  }
  const sensor_msgs::PointCloud2 message = cloud.update(*world.model, world.state, 1);
  sensor_msgs::PointCloud2ConstIterator<float> strain(message, "strain");
  for (; strain != strain.end(); ++strain) EXPECT_NEAR(*strain, 0.03, 1e-4);
}

TEST(Topology, describesTheMeshAndItsRestShape) {
  const World world = balloon();
  const vibe_msgs::TissueTopology message = makeTopology(*world.model, 2, 5);
  EXPECT_EQ(message.revision, 2u);
  EXPECT_EQ(message.header.frame_id, "stomach");
  EXPECT_EQ(message.triangles.size(), 3u * 320u);
  EXPECT_EQ(message.rest_positions.size(), 3u * 162u);
  EXPECT_EQ(message.rest_positions[7], world.model->organ.surface.vertices[2].y());
  EXPECT_EQ(message.region.size(), 162u);
  EXPECT_EQ(message.wall.size(), 162u);
  EXPECT_EQ(message.end.size(), 162u);
  EXPECT_FLOAT_EQ(message.thickness[161], 2e-3f);
  EXPECT_TRUE(message.render_triangles.empty());
}

}  // namespace
}  // namespace vibe::sim::particle_cloud_test
