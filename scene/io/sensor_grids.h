#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Points of a scene file at which illuminance is asked for, one by one.
struct SensorGrid {
  std::string name{};
  std::string group{};                        ///< empty: none
  std::vector<Eigen::Vector3d> positions{};   ///< m
  std::vector<Eigen::Vector3d> directions{};  ///< unit vectors that the sensors face
};

/// The sensor grids in the file of `scene`: those of a Honeybee model, and none in files of other
/// formats. Sensors without a direction face up. Throws what read_scene() throws.
std::vector<SensorGrid> read_sensor_grids(const Scene& scene);
/// read_sensor_grids() of a Honeybee model.
std::vector<SensorGrid> read_honeybee_grids(const std::filesystem::path& path);

}  // namespace lightwell
