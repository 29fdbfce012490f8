#include "scene/io/pov/pov_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "scene/degree.h"
#include "scene/errors.h"
#include "scene/io/directional_light.h"
#include "scene/io/pov/pov_materials.h"
#include "scene/io/pov/pov_transform.h"
#include "scene/limits.h"

namespace lightwell {

/// Words of a light source, in its own space.
struct PovLight {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  PovVector color{.count = 5};
  bool is_spot = false, is_cylinder = false, is_parallel = false, is_circular = false;
  double radius = 30.0, falloff = 45.0, tightness = 0.0;  // degrees; of a cylinder, lengths
  Eigen::Vector3d point_at = Eigen::Vector3d::Zero();
  bool aims = false, is_area = false;
  Eigen::Vector3d along = Eigen::Vector3d::Zero(), beside = Eigen::Vector3d::Zero();
  double fade_distance = 0.0, fade_power = 0.0;
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
};

namespace {

class LightReader {
 public:
  LightReader(const PovNode& node, const std::string& name, Remarks& remarks)
      : cursor_(node), name_(name), remarks_(remarks) {}

  PovLight read(const Eigen::Affine3d& to_world) {
    PovLight light;
    Eigen::Affine3d moved = Eigen::Affine3d::Identity();
    if (const PovNode* declared = cursor_.block(); declared) {
      if (declared->keyword != "light_source") cursor_.node().fail("has no place");
      light = LightReader(*declared, name_, remarks_).read(Eigen::Affine3d::Identity());
      moved = light.to_world;
    } else {
      light.position = cursor_.need_point("place");
      const auto color = cursor_.vector();
      if (!color) cursor_.node().fail("has no colour");
      light.color = pov_color(*color);
    }
    while (!cursor_.at_end()) {
      if (!take_pov_transform(cursor_, moved)) read_word(light);
    }
    light.to_world = to_world * moved;
    return light;
  }

 private:
  void read_word(PovLight& light) {
    const PovItem& item = cursor_.next();
    const std::string_view word = item.word;
    if (word == "spotlight") {
      light.is_spot = true;
    } else if (word == "cylinder") {
      light.is_cylinder = true;
    } else if (word == "parallel") {
      light.is_parallel = true;
    } else if (word == "radius") {
      light.radius = cursor_.need_number("radius");
    } else if (word == "falloff") {
      light.falloff = cursor_.need_number("falloff");
    } else if (word == "tightness") {
      light.tightness = cursor_.need_number("tightness");
    } else if (word == "point_at") {
      light.point_at = cursor_.need_point("point_at");
      light.aims = true;
    } else if (word == "area_light") {
      light.is_area = true;
      light.along = cursor_.need_point("first edge");
      light.beside = cursor_.need_point("second edge");
      cursor_.number();
      cursor_.number();
    } else if (word == "circular") {
      light.is_circular = true;
    } else if (word == "fade_distance") {
      light.fade_distance = cursor_.need_number("fade_distance");
    } else if (word == "fade_power") {
      light.fade_power = cursor_.need_number("fade_power");
    } else if (word == "shadowless") {
      remarks_.add("Lights without shadows ('shadowless') cast them here", name_);
    } else if (item.node()) {
      const std::string_view block = item.node()->keyword;
      if (block == "looks_like" || block == "projected_through" || block == "photons") {
        remarks_.add(fmt::format("'{}' of lights was left out", block), name_);
      }
    } else {
      pass_word(word);
    }
  }

  void pass_word(std::string_view word) {
    constexpr std::array<std::string_view, 7> without_effect = {"jitter",
                                                                "orient",
                                                                "adaptive",
                                                                "area_illumination",
                                                                "media_attenuation",
                                                                "media_interaction",
                                                                "groups"};
    if (std::ranges::find(without_effect, word) == without_effect.end()) {
      remarks_.add("Words of lights that are not known were left out", word);
    }
    cursor_.vector();
  }

  PovCursor cursor_;
  const std::string& name_;
  Remarks& remarks_;
};

// cos^tightness, times 1 within the radius and a cubic step down to 0 at the falloff.
SharedWeb tight_beam(double radius, double falloff, double tightness) {
  constexpr int steps = 180;
  std::vector<double> gammas;
  Eigen::ArrayXXd values(1, steps + 1);
  const double last = std::min(falloff, 90.0);
  for (int i = 0; i <= steps; ++i) {
    const double angle = last * i / steps;
    const double step =
        falloff > radius ? std::clamp((falloff - angle) / (falloff - radius), 0.0, 1.0) : 1.0;
    gammas.push_back(angle);
    values(0, i) = std::pow(std::cos(angle * degree), tightness) * step * step * (3.0 - 2.0 * step);
  }
  return std::make_shared<const PhotometricWeb>(std::vector{0.0}, std::move(gammas), values);
}

}  // namespace

void PovLights::add(const PovNode& node, const Eigen::Affine3d& to_world, const std::string& name,
                    double gamma, Scene& scene, Remarks& remarks) {
  const std::string label = names_.unique(name.empty() ? "light" : name);
  const PovLight light = LightReader(node, label, remarks).read(to_world);
  const Eigen::Vector3d position = light.to_world * light.position;
  const Eigen::Vector3d aimed_at = light.to_world * light.point_at;
  const Eigen::Vector3d aim = aimed_at - position;
  const double distance = aim.stableNorm();
  if (!position.allFinite() || !(position.cwiseAbs().maxCoeff() <= farthest_coordinate)) {
    node.fail(fmt::format("is farther than {:g} from the origin", farthest_coordinate));
  }
  Spectrum irradiance = std::numbers::pi_v<float> * pov_linear(light.color, gamma);
  if (!(irradiance > 0.0f).any()) return remarks.add("Lights without light were left out", label);
  irradiance = irradiance.min(most_light);
  if (light.is_parallel) {
    if (!(distance > 0.0)) node.fail("has no direction: it points at its own place");
    return add_directional_light(-aim, irradiance, label, scene, remarks);
  }
  Lamp lamp{.name = label, .position = position, .visible = false};
  const bool is_beam = light.is_spot || light.is_cylinder;
  if (is_beam && !(distance > 0.0)) node.fail("has no direction: it points at its own place");
  const Eigen::Vector3d along = light.to_world.linear() * light.along,
                        beside = light.to_world.linear() * light.beside;
  if (light.is_area) {
    lamp.opening = {
        .along_c0 = along.norm(), .along_c90 = beside.norm(), .is_round = light.is_circular};
  }
  const Eigen::Vector3d across = along.cross(beside);
  const Eigen::Vector3d axis = is_beam || !(across.norm() > 0.0) ? aim : across;
  lamp.axes = lamp_axes(axis.stableNorm() > 0.0 ? Eigen::Vector3d(axis.stableNormalized())
                                                : Eigen::Vector3d(-Eigen::Vector3d::UnitY()),
                        along);
  if (is_beam) set_beam(light, distance, node, lamp, remarks);
  if (light.is_cylinder)
    remarks.add("Cylinders of light became cones as wide where they aim", label);
  lamp.intensity = irradiance;
  const bool fades = light.fade_distance > 0.0 && light.fade_power > 0.0;
  if (fades) {
    if (light.fade_power != 2.0) {
      remarks.add("Lights fade by the square of the distance, not by another power", label);
    }
    const double factor = 2.0 * light.fade_distance * light.fade_distance;
    lamp.intensity *= static_cast<float>(std::min(factor, double{most_light}));
    lamp.intensity = lamp.intensity.min(most_light);
  } else {
    remarks.mention(
        "Lights that do not fade got the intensity of one that fades by the square of "
        "the distance and is as bright where it aims, or in the middle of the scene",
        label);
    Unfading unfading{.lamp = scene.lamps.size()};
    if (is_beam) unfading.aimed_at = aimed_at;
    unfading_.push_back(unfading);
  }
  scene.lamps.push_back(std::move(lamp));
}

void PovLights::set_beam(const PovLight& light, double distance, const PovNode& node, Lamp& lamp,
                         Remarks& remarks) {
  double radius = light.radius, falloff = light.falloff;
  if (light.is_cylinder) {
    // The cone that is as wide at the point aimed at.
    radius = std::atan2(radius, distance) / degree;
    falloff = std::atan2(falloff, distance) / degree;
  }
  if (!(falloff > 0.0 && falloff <= 180.0 && radius >= 0.0)) {
    node.fail(
        fmt::format("has a radius of {:g} and a falloff of {:g} degrees; it needs 0 <= radius "
                    "<= falloff <= 180",
                    radius, falloff));
  }
  radius = std::min(radius, falloff);
  lamp.shape = SpotCone{.inner = radius * degree, .outer = falloff * degree};
  const double tightness = std::clamp(light.tightness, 0.0, 1e4);
  if (!(tightness > 0.0)) return;
  constexpr std::size_t most_beams = 200;  // tables of 0.2 MB
  SharedWeb& web = beams_[{radius, falloff, tightness}];
  if (!web && beams_.size() > most_beams) {
    return remarks.add("'tightness' was left out in lights beyond 200 different beams", lamp.name);
  }
  if (!web) web = tight_beam(radius, falloff, tightness);
  lamp.shape = web;
}

void PovLights::finish(const Eigen::Vector3d& middle, Scene& scene) const {
  for (const Unfading& light : unfading_) {
    Lamp& lamp = scene.lamps[light.lamp];
    const double square = (light.aimed_at.value_or(middle) - lamp.position).squaredNorm();
    lamp.intensity *= static_cast<float>(std::clamp(square, 1e-6, 1e20));
    lamp.intensity = lamp.intensity.min(most_light);
  }
}

}  // namespace lightwell
