#include "daylight/honeybee_metrics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/temporary_folder.h"

namespace lightwell::honeybee_metrics_test {
namespace {

SensorMetrics metrics_of_three_sensors() {
  SensorMetrics metrics;
  metrics.autonomy = Eigen::Array3d(10.0, 20.5, 33.333);
  metrics.continuous_autonomy = Eigen::Array3d(40.0, 50.0, 60.0);
  metrics.below_100 = Eigen::Array3d(5.0, 6.0, 7.0);
  metrics.from_100_to_300 = Eigen::Array3d(20.0, 30.0, 40.0);
  metrics.from_300_to_3000 = Eigen::Array3d(70.0, 60.0, 50.0);
  metrics.above_3000 = Eigen::Array3d(5.0, 4.0, 3.0);
  return metrics;
}

TEST(HoneybeeMetrics, EachGridHasAFileOfEachMeasure) {
  const TemporaryFolder folder;
  const std::vector<MetricGrid> grids = {
      {.name = "hall", .first = 0, .count = 2},
      {.name = "desk", .group = "level 1", .first = 2, .count = 1}};
  write_honeybee_metrics(folder.path(), grids, metrics_of_three_sensors());
  EXPECT_EQ(content_of(folder / "da/hall.da"), "10.00\n20.50\n");
  EXPECT_EQ(content_of(folder / "da/level_1/desk.da"), "33.33\n");
  EXPECT_EQ(content_of(folder / "cda/hall.cda"), "40.00\n50.00\n");
  EXPECT_EQ(content_of(folder / "udi_lower/hall.udi"), "5.00\n6.00\n");
  EXPECT_EQ(content_of(folder / "udi/hall.udi"), "90.00\n90.00\n");
  EXPECT_EQ(content_of(folder / "udi_upper/level_1/desk.udi"), "3.00\n");
  const auto info = nlohmann::json::parse(content_of(folder / "udi/grids_info.json"));
  ASSERT_EQ(info.size(), 2u);
  EXPECT_EQ(info[1]["full_id"], "level_1/desk");
  EXPECT_EQ(info[1]["group"], "level 1");
  EXPECT_EQ(info[0]["count"], 2);
  for (const auto& file : honeybee_metric_files(grids)) {
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path() / file)) << file;
  }
}

TEST(HoneybeeMetrics, NamesNeitherLeaveTheFolderNorMeet) {
  const std::vector<MetricGrid> grids = {
      {.name = "a/b"}, {.name = "a b"}, {.name = "../c"}, {.name = "c", .group = ".."}};
  const auto files = honeybee_metric_files(grids);
  ASSERT_GE(files.size(), 4u);
  EXPECT_EQ(files[0], "da/a_b.da");
  EXPECT_EQ(files[1], "da/a_b_2.da");
  EXPECT_EQ(files[2], "da/.._c.da");
  EXPECT_EQ(files[3], "da/_../c.da");
}

}  // namespace
}  // namespace lightwell::honeybee_metrics_test
