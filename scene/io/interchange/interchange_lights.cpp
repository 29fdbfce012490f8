#include "scene/io/interchange/interchange_lights.h"

#include <fmt/format.h>

#include <assimp/scene.h>
#include <assimp/version.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "scene/errors.h"
#include "scene/io/camera_name.h"
#include "scene/io/directional_light.h"

namespace lightwell {
namespace {

template <class Thing>
std::vector<std::string> names_of(std::span<Thing* const> things) {
  std::vector<std::string> names;
  for (const Thing* thing : things) names.emplace_back(thing->mName.C_Str());
  return names;
}

// The formats give full angles. A COLLADA spot ends sharply: the library gives an outer angle that
// the format does not have.
SpotCone cone_of(const aiLight& light, bool is_fbx) {
  const double widest = std::numbers::pi;
  const auto half = [&](float angle) {
    return std::isfinite(angle) ? std::clamp(0.5 * static_cast<double>(angle), 0.0, widest)
                                : widest;
  };
  const double outer = half(is_fbx ? light.mAngleOuterCone : light.mAngleInnerCone);
  if (!(outer > 0.0)) throw InputError("the cone of the spot has no width");
  return {.inner = is_fbx ? std::min(half(light.mAngleInnerCone), outer) : outer, .outer = outer};
}

void add_light(const aiLight& light, const ImportedNode& place, bool is_fbx, Scene& scene,
               Remarks& remarks) {
  Spectrum color(3);
  color << light.mColorDiffuse.r, light.mColorDiffuse.g, light.mColorDiffuse.b;
  if (!(color >= 0.0f).all() || !color.isFinite().all()) {
    throw InputError("the colour is below 0, or too large");
  }
  const Eigen::Vector3d aim = place.to_world.linear() * vector_of(light.mDirection);
  if (light.mType != aiLightSource_POINT && !(aim.stableNorm() > 0.0)) {
    throw InputError("the light has no direction");
  }
  if (light.mType == aiLightSource_DIRECTIONAL) {
    return add_directional_light(-aim, color, place.name, scene, remarks);
  }
  // The library invents the attenuation of FBX files.
  if (!is_fbx && (light.mAttenuationLinear != 0.0f || light.mAttenuationQuadratic != 0.0f)) {
    remarks.add(
        "Attenuations of lights were passed over: light falls off with the square of its "
        "distance",
        place.name);
  }
  Lamp lamp{.name = place.name,
            .position = place.to_world * vector_of(light.mPosition),
            .intensity = color};
  if (light.mType == aiLightSource_SPOT) {
    lamp.shape = cone_of(light, is_fbx);
    lamp.axes = lamp_axes(aim.stableNormalized());
  }
  scene.lamps.push_back(std::move(lamp));
}

// Full horizontal angle, degrees. assimp gives half of FBX's angle from 5.3 on.
double fov_of(const aiCamera& from, bool is_fbx) {
  const bool is_half = is_fbx && (aiGetVersionMajor() > 5 || aiGetVersionMinor() > 2);
  const double degrees = static_cast<double>(from.mHorizontalFOV) * 180.0 / std::numbers::pi;
  return is_half ? 2.0 * degrees : degrees;
}

void add_camera(const aiCamera& from, const ImportedNode& place, bool is_fbx, Scene& scene,
                Remarks& remarks) {
  constexpr double extreme = 32.0;  // the picture would be a line beyond
  constexpr double usual_aspect = 4.0 / 3.0;
  constexpr int usual_height = 512;
  const double fov = fov_of(from, is_fbx);
  if (!(fov > 0.0 && fov < 180.0)) {
    throw InputError(fmt::format("the angle of view is {:g} degrees", fov));
  }
  const double aspect = from.mAspect == 0.0f ? usual_aspect : static_cast<double>(from.mAspect);
  if (!(aspect < extreme && aspect > 1.0 / extreme)) {
    throw InputError(fmt::format("the aspect is {:g}, and no picture is of that shape", aspect));
  }
  Camera camera{.name = camera_name(place.name, scene)};
  camera.fov_degrees = fov;
  camera.height = usual_height;
  camera.width = static_cast<int>(std::lround(usual_height * aspect));
  if (!place_camera(place.to_world, vector_of(from.mLookAt), camera, remarks)) {
    throw InputError("the camera has no direction or no upright");
  }
  scene.cameras.push_back(camera);
}

}  // namespace

void add_interchange_lights(const ImportedFile& file, Scene& scene, Remarks& remarks) {
  const std::span lights(file.scene().mLights, file.scene().mNumLights);
  const std::vector<std::string> names = names_of<aiLight>(lights);
  const std::vector<int> places = file.places_of(names);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const aiLight& light = *lights[i];
    const bool is_used = light.mType == aiLightSource_POINT || light.mType == aiLightSource_SPOT ||
                         light.mType == aiLightSource_DIRECTIONAL;
    if (!is_used) {
      remarks.add("Ambient light, luminous areas and volumes were left out", names[i]);
    } else if (places[i] >= 0) {
      const ImportedNode& place = file.nodes()[static_cast<std::size_t>(places[i])];
      remarks.attempt("Lights that cannot be used were left out", place.name,
                      [&] { add_light(light, place, file.is_fbx(), scene, remarks); });
    }
  }
}

void add_interchange_cameras(const ImportedFile& file, Scene& scene, Remarks& remarks) {
  const std::span cameras(file.scene().mCameras, file.scene().mNumCameras);
  const std::vector<int> places = file.places_of(names_of<aiCamera>(cameras));
  if (!file.is_fbx() && !cameras.empty() && file.has_word("<orthographic>")) {
    remarks.add("Cameras without perspective were read as cameras with one", scene.title);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (places[i] < 0) continue;
    const ImportedNode& place = file.nodes()[static_cast<std::size_t>(places[i])];
    remarks.attempt("Cameras that cannot be used were left out", place.name,
                    [&] { add_camera(*cameras[i], place, file.is_fbx(), scene, remarks); });
  }
}

}  // namespace lightwell
