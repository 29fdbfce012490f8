#include "daylight/window_operation.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "daylight/year.h"
#include "scene/errors.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {
namespace {

// Hours whose sunlight is in memory together.
constexpr std::size_t hours_at_once = 512;

// Most points of a group at which its illuminance is looked at.
constexpr std::size_t most_facets = 64;

// The model of what sensors see of sun and sky in a scene like that of `like`.
DaylightModel direct_model(const DaylightModel& like, Scene scene) {
  DaylightOptions options = like.options();
  options.direct_only = true;
  return {std::move(scene), like.sky().up(), like.sky().north(), options};
}

// The scene with the surfaces of a group opaque and black.
Scene without_group(Scene scene, const WindowGroup& group) {
  Material black{.name = group.name};
  for (Spectrum* spectrum : {&black.reflectance, &black.specular, &black.emission}) {
    *spectrum = constant_spectrum(scene.bands, 0.0f);
  }
  const int number = static_cast<int>(scene.materials.size());
  scene.materials.push_back(std::move(black));
  for (const int surface : group.surfaces) {
    scene.surfaces[static_cast<std::size_t>(surface)].material = number;
  }
  return scene;
}

// Direct sunlight of the sensors, lx, sensors x hours.
Eigen::ArrayXXf sunlight_of_hours(const DaylightModel& model, std::span<const SkyHour> hours) {
  std::vector<SunDisc> suns;
  for (const SkyHour& hour : hours) suns.emplace_back(model.sky(), hour.sun);
  Eigen::ArrayXXf lux = model.direct_sun(suns);
  for (std::size_t h = 0; h < hours.size(); ++h) {
    lux.col(static_cast<Eigen::Index>(h)) *= static_cast<float>(hours[h].sun_lux);
  }
  return lux;
}

// True if the sunlight that a group lets in, per sensor, closes the group.
bool closes_by_sun(const Eigen::Ref<const Eigen::ArrayXf>& sunlight,
                   std::span<const SensorRange> rooms) {
  return std::ranges::any_of(rooms, [&](const SensorRange& room) {
    const auto sunny = (sunlight.segment(room.first, room.count) >= lm_83_sunlight).count();
    return static_cast<double>(sunny) > lm_83_share * static_cast<double>(room.count);
  });
}

void operate_by_lm_83(const DaylightModel& open, const OperatedWindows& windows,
                      const OperationTask& task, Eigen::ArrayXXi& states) {
  std::vector<Eigen::Index> numbers;
  for (std::size_t g = 0; g < windows.groups.size(); ++g) {
    if (windows.groups[g].operation == WindowOperation::lm_83) {
      numbers.push_back(static_cast<Eigen::Index>(g));
    }
  }
  for (const Eigen::Index g : numbers) {
    const WindowGroup& group = windows.groups[static_cast<std::size_t>(g)];
    DaylightModel without = direct_model(open, without_group(open.scene(), group));
    without.set_sensors(open.sensors());
    for (std::size_t first = 0; first < task.hours.size(); first += hours_at_once) {
      const auto hours =
          task.hours.subspan(first, std::min(hours_at_once, task.hours.size() - first));
      const Eigen::ArrayXXf through =
          sunlight_of_hours(open, hours) - sunlight_of_hours(without, hours);
      for (Eigen::Index h = 0; h < through.cols(); ++h) {
        if (closes_by_sun(through.col(h), task.rooms)) {
          states(g, static_cast<Eigen::Index>(first) + h) = group.state;
        }
      }
    }
  }
}

// A point on either side of the largest element of each facet of a group, of at most most_facets.
std::vector<GatherPoint> points_of_group(const DaylightModel& model, const WindowGroup& group) {
  const PatchMesh& mesh = model.mesh();
  std::vector<int> largest(scene_facets(model.scene()).size(), -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const int surface = mesh.surface[static_cast<std::size_t>(mesh.patch[i])];
    if (!std::ranges::binary_search(group.surfaces, surface)) continue;
    int& best = largest[static_cast<std::size_t>(mesh.facet[i])];
    if (best < 0 || mesh.element_area[e] > mesh.element_area[best]) best = e;
  }
  std::erase(largest, -1);
  std::vector<GatherPoint> points;
  const std::size_t count = std::min(most_facets, largest.size());
  for (std::size_t i = 0; i < count; ++i) {
    const int e = largest[i * largest.size() / count];
    const PatchPoint center = element_center(mesh, e);
    for (const double side : {1.0, -1.0}) {
      points.push_back({.position = center.position,
                        .normal = side * center.normal,
                        .facet = mesh.facet[static_cast<std::size_t>(e)]});
    }
  }
  return points;
}

// Closes and opens a group by the greatest illuminance of its points.
void operate_by_illuminance(const DaylightModel& open, const WindowGroup& group,
                            const OperationTask& task, Eigen::Ref<Eigen::ArrayXi> states) {
  DaylightModel panes = direct_model(open, open.scene());
  panes.set_sensors(points_of_group(panes, group));
  bool is_closed = false;
  int before = std::numeric_limits<int>::min();
  Eigen::Index at = 0;
  simulate_year(panes, panes.sky_coefficients().sum(), task.hours, task.ground_reflectance,
                [&](const HourBlock& block) {
                  for (std::size_t h = 0; h < block.hours.size(); ++h) {
                    const int number = block.hours[h].number;
                    if (number != before + 1) is_closed = false;
                    before = number;
                    const double lux =
                        double{block.total.col(static_cast<Eigen::Index>(h)).maxCoeff()};
                    is_closed = lux > group.close_above || (is_closed && lux >= group.open_below);
                    states[at++] = is_closed ? group.state : 0;
                  }
                });
}

void operate_by_schedule(const WindowGroup& group, const OperationTask& task,
                         Eigen::Ref<Eigen::ArrayXi> states) {
  const std::size_t year = hours_a_day * (task.is_leap_year ? 366u : 365u);
  if (!group.hours.empty() && group.hours.size() != year) {
    throw InputError(fmt::format(
        "the schedule of the windows '{}' has {} hours, and the weather file {}; give a state for "
        "each hour of the weather file",
        group.name, group.hours.size(), year));
  }
  for (std::size_t h = 0; h < task.hours.size(); ++h) {
    const int number = task.hours[h].number;
    int& state = states[static_cast<Eigen::Index>(h)];
    if (!group.hours.empty()) {
      state = group.hours[static_cast<std::size_t>(number)];
      continue;
    }
    const auto [month, day, hour] = hour_of_year(number, task.is_leap_year);
    for (const ScheduleSpan& span : group.spans) {
      if (span.contains(month, day, hour)) state = span.state;
    }
  }
}

// Refuses surfaces that have become parts of others, or of which nothing is left.
void require_area(const Scene& scene, const WindowGroup& group) {
  for (const int number : group.surfaces) {
    const Surface& surface = scene.surfaces[static_cast<std::size_t>(number)];
    if (surface_area(surface) > 0.0) continue;
    throw InputError(fmt::format(
        "windows '{}': the surface '{}' lies in the plane of a neighbour of the same material and "
        "was joined with that; give it a material that differs, if only by a thousandth",
        group.name, surface.name));
  }
}

}  // namespace

Eigen::ArrayXXi operate_windows(const DaylightModel& open, const OperatedWindows& windows,
                                const OperationTask& task) {
  const auto groups = static_cast<Eigen::Index>(windows.groups.size());
  Eigen::ArrayXXi states =
      Eigen::ArrayXXi::Zero(groups, static_cast<Eigen::Index>(task.hours.size()));
  for (const WindowGroup& group : windows.groups) require_area(open.scene(), group);
  operate_by_lm_83(open, windows, task, states);
  for (Eigen::Index g = 0; g < groups; ++g) {
    const WindowGroup& group = windows.groups[static_cast<std::size_t>(g)];
    Eigen::ArrayXi of_group = states.row(g).transpose();
    if (group.operation == WindowOperation::always) of_group.setConstant(group.state);
    if (group.operation == WindowOperation::schedule) operate_by_schedule(group, task, of_group);
    if (group.operation == WindowOperation::illuminance) {
      operate_by_illuminance(open, group, task, of_group);
    }
    states.row(g) = of_group.transpose();
  }
  return states;
}

std::string operation_text(const WindowGroup& group) {
  const std::string& state = group.states[static_cast<std::size_t>(group.state)].name;
  switch (group.operation) {
    case WindowOperation::always:
      return fmt::format("always {}", state);
    case WindowOperation::schedule:
      return "by a schedule";
    case WindowOperation::illuminance:
      return fmt::format("{} above {:g} lx on the panes, open again below {:g} lx", state,
                         group.close_above, group.open_below);
    case WindowOperation::lm_83:
      break;
  }
  return fmt::format(
      "{} while more than 2 % of a room's sensors get 1000 lx or more straight from the sun "
      "through these windows (IES LM-83-12, 2.2.6)",
      state);
}

}  // namespace lightwell
