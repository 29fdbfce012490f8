#include "scene/io/toml/toml_projectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "scene/degree.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// Opposite blades must leave some of the picture.
void check_blades(const TomlValue& value, const char* first, double a, const char* second,
                  double b) {
  if (a + b < 1.0) return;
  value.fail(
      fmt::format("leave nothing of the picture: '{}' cuts off {:g} of it and '{}' {:g}; "
                  "together they must be below 1",
                  first, a, second, b));
}

ProjectorOptics::Shutters read_shutters(const TomlValue& value) {
  const TomlTable table = value.table({"left", "right", "top", "bottom"});
  const auto share = [&](const char* key) {
    const auto given = table.find(key);
    return given ? given->number_within(0.0, 1.0) : 0.0;
  };
  const ProjectorOptics::Shutters shutters{.left = share("left"),
                                           .right = share("right"),
                                           .top = share("top"),
                                           .bottom = share("bottom")};
  check_blades(value, "left", shutters.left, "right", shutters.right);
  check_blades(value, "top", shutters.top, "bottom", shutters.bottom);
  return shutters;
}

ProjectorOptics read_optics(const TomlTable& lamp, double metres_per_unit) {
  ProjectorOptics optics;
  const auto beam = lamp.find("beam");
  if (!beam) {
    lamp.fail("projects a 'picture' and needs a 'beam', the angle across the picture in degrees");
  }
  constexpr double narrowest = 0.1, widest = 170.0;
  optics.beam = std::min(beam->number_within(narrowest, widest) * degree, widest_beam);
  const auto focus = lamp.find("focus"), lens = lamp.find("lens");
  if (lens && !focus) {
    lens->fail("blurs the picture before and behind its 'focus'; give that too, or remove it");
  }
  if (focus) {
    optics.focus = metres_per_unit * focus->positive();
    optics.lens = std::min(optics.lens, optics.focus);
  }
  if (lens) {
    optics.lens = metres_per_unit * lens->positive();
    if (optics.lens > optics.focus) {
      lens->fail("is wider than the 'focus' is away; check the two");
    }
  }
  if (const auto shutters = lamp.find("shutters")) optics.shutters = read_shutters(*shutters);
  return optics;
}

LightPicture read_light(const TomlValue& file, PictureFiles& files) {
  const auto path = (file.file().parent_path() / file.name()).lexically_normal();
  try {
    if (const auto light = files.light(path, PictureCode::srgb)) return *light;
  } catch (const InputError& error) {
    file.fail(fmt::format("cannot be used: {}", error.what()));
  }
  file.fail(fmt::format("is '{}', which is no PNG, JPEG, EXR or HDR; save it as one",
                        path.filename().string()));
}

}  // namespace

std::shared_ptr<const PictureSums> TomlProjectors::slide(
    const TomlValue& file, const std::shared_ptr<const Texture>& picture) {
  // Sums of the largest picture take 400 MB.
  constexpr std::int64_t most = std::int64_t{1} << 24;
  const std::int64_t texels = std::int64_t{picture->width()} * picture->height();
  if (texels > most) {
    file.fail(
        fmt::format("has {} x {} pixels; a lamp projects at most {} of them, so make the "
                    "picture smaller",
                    picture->width(), picture->height(), most));
  }
  std::shared_ptr<const PictureSums>& known = slides_[picture.get()];
  if (!known) known = std::make_shared<const PictureSums>(picture);
  return known;
}

TomlProjector TomlProjectors::read(const TomlTable& lamp, double metres_per_unit) {
  for (const auto& key : lamp.present({"file", "cone", "lamp_set"})) {
    lamp.require(key).fail(
        "contradicts 'picture', by which the lamp's light is spread; remove one");
  }
  for (const auto& key : lamp.present({"opening", "round"})) {
    lamp.require(key).fail(
        "does not go with a 'picture', which leaves a point; the 'lens' has a size");
  }
  if (const auto c0 = lamp.find("c0")) {
    c0->fail("does not go with a 'picture'; 'up' turns it");
  }
  const ProjectorOptics optics = read_optics(lamp, metres_per_unit);
  const TomlValue file = lamp.require("picture");
  const LightPicture light = read_light(file, files_);
  return {
      .picture = std::make_shared<const ProjectedPicture>(slide(file, light.color), optics, basis_),
      .brightest = light.brightest};
}

}  // namespace lightwell
