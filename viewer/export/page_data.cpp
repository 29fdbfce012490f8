#include "viewer/export/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>

#include "raytrace/pictures/encode_png.h"
#include "viewer/export/baked_channels.h"
#include "viewer/export/fan.h"
#include "viewer/export/page_arrays.h"
#include "viewer/export/page_year.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

/// Largest coordinate in 21 bits; three coordinates take 8 bytes. Half a step is 2.4 micrometres in
/// a room of 10 m.
constexpr double largest_place = (1 << 21) - 1;

struct Box {
  Eigen::Vector3d low, high;
};

Box turned_bounds(const BakedModel& model) {
  Box box{model.to_y_up * model.position.front(), model.to_y_up * model.position.front()};
  for (const Eigen::Vector3d& p : model.position) {
    const Eigen::Vector3d turned = model.to_y_up * p;
    box.low = box.low.cwiseMin(turned);
    box.high = box.high.cwiseMax(turned);
  }
  return box;
}

void append_positions(const BakedModel& model, const Box& box, PageData& page) {
  const double longest = (box.high - box.low).maxCoeff();
  const double step = longest > 0.0 ? longest / largest_place : 1.0;
  page.about["positions"] = {{"offset", page.bytes.size()}, {"step", step}};
  for (const Eigen::Vector3d& p : model.position) {
    const Eigen::Vector3d place = (model.to_y_up * p - box.low) / step;
    std::uint64_t packed = 0;
    for (int c = 0; c < 3; ++c) {
      packed |= static_cast<std::uint64_t>(std::llround(place[c])) << (21 * c);
    }
    append_bytes(page.bytes, packed);
  }
}

void append_faces(const BakedModel& model, PageData& page) {
  page.about["corners"] = {{"offset", page.bytes.size()}};
  for (const auto& face : model.faces) {
    for (const int v : face) append_bytes(page.bytes, static_cast<std::uint32_t>(v));
  }
  page.about["black_behind"] = {{"offset", page.bytes.size()}};
  page.bytes.append(model.black_behind.begin(), model.black_behind.end());
  page.bytes.resize((page.bytes.size() + 3) / 4 * 4);
}

Json append_channel(const BakedChannel& channel, std::string& bytes) {
  Json basis = {{"name", channel.name},
                {"weight", numbers(channel.weight)},
                {"lumens", numbers(channel.lumens)}};
  basis["radiance"] = append_halves(numbers(channel.radiance), bytes);
  basis["illuminance"] = append_halves(numbers(channel.illuminance), bytes);
  return basis;
}

/// Terms whose weighted sum is the light: the channels, or one basis for all light.
Json append_bases(const BakedModel& model, std::string& bytes) {
  Json bases = Json::array();
  for (const BakedChannel& channel : model.channels) {
    bases.push_back(append_channel(channel, bytes));
  }
  if (!bases.empty()) return bases;
  Json basis = {{"name", "all light"}};
  basis["radiance"] = append_halves(numbers(model.radiance), bytes);
  const RgbArray shares = illuminance_shares(model.irradiance, model.bands);
  basis["illuminance"] = append_halves(numbers(shares), bytes);
  bases.push_back(std::move(basis));
  return bases;
}

Json cues(const BakedModel& model) {
  Json result = Json::array();
  for (const BakedCue& cue : model.cues) {
    Json weights = Json::array();
    for (const Eigen::Array3f& weight : cue.weights) weights.push_back(numbers(weight));
    result.push_back({{"name", cue.name},
                      {"wait", cue.wait},
                      {"fade_up", cue.fade_up},
                      {"fade_down", cue.fade_down},
                      {"hold", cue.hold},
                      {"weights", std::move(weights)}});
  }
  return result;
}

// Appends picture coordinates, picture gains and the pictures as PNG.
void append_pictures(const BakedModel& model, PageData& page) {
  if (model.pictures.empty()) return;
  page.about["places"] = {{"offset", page.bytes.size()}};
  for (const Eigen::Vector2f& place : model.place) {
    for (const float x : place) append_bytes(page.bytes, x);
  }
  page.about["picture_gain"] = append_halves(numbers(model.picture_gain), page.bytes);
  Json pictures = Json::array();
  for (const DrawnPicture& picture : model.pictures) {
    const std::string png = encode_png(picture.width, picture.height, picture.rgba);
    const auto wrap = [](TextureWrap how) {
      return how == TextureWrap::clamp ? "clamp" : how == TextureWrap::mirror ? "mirror" : "repeat";
    };
    pictures.push_back({{"offset", page.bytes.size()},
                        {"length", png.size()},
                        {"wrap", {wrap(picture.wrap[0]), wrap(picture.wrap[1])}},
                        {"is_smooth", picture.is_smooth},
                        {"has_holes", picture.has_holes}});
    page.bytes += png;
    page.bytes.resize((page.bytes.size() + 3) / 4 * 4);
  }
  page.about["pictures"] = std::move(pictures);
}

/// Appends sky and sun. Rows of `axes` are north, east and up in the page's axes.
void append_sky(const BakedModel& model, PageData& page) {
  if (!model.sky) return;
  const BakedSky& sky = *model.sky;
  const Eigen::Matrix3d axes = model.to_y_up * sky.axes;
  Json about = {
      {"columns", sky.columns},
      {"rows_above", sky.rows_above},
      {"rows_below", sky.rows_below},
      {"axes", {vector_json(axes.col(0)), vector_json(axes.col(1)), vector_json(axes.col(2))}},
      {"basis", sky.channel}};
  about["radiance"] = append_halves(numbers(sky.radiance), page.bytes);
  if (sky.sun) {
    about["sun"] = {{"direction", vector_json(model.to_y_up * *sky.sun)},
                    {"cosine_of_edge", sky.cosine_of_edge},
                    {"radiance", numbers(sky.sun_radiance)},
                    {"basis", sky.sun_channel}};
  }
  page.about["sky"] = std::move(about);
}

/// Appends the luminaires' triangles. Faces share no corners; radiance is that of each basis.
void append_lamps(const BakedModel& model, const Box& box, PageData& page) {
  if (model.lamp_faces.empty()) return;
  std::string& bytes = page.bytes;
  Json about = {{"positions", bytes.size()}};
  std::uint32_t corners = 0;
  std::vector<std::uint32_t> triangles;
  for (const BakedLampFace& face : model.lamp_faces) {
    for (const Eigen::Vector3d& p : face.outline) {
      const Eigen::Vector3d place = model.to_y_up * p - box.low;
      for (const double x : place) append_bytes(bytes, static_cast<float>(x));
    }
    const auto count = static_cast<std::uint32_t>(face.outline.size());
    append_fan(corners, count, triangles);
    corners += count;
  }
  about["corner_count"] = corners;
  about["triangles"] = bytes.size();
  about["triangle_count"] = triangles.size() / 3;
  for (const std::uint32_t corner : triangles) append_bytes(bytes, corner);
  Json radiance = Json::array();
  for (std::size_t c = 0; c < std::max<std::size_t>(1, model.channels.size()); ++c) {
    radiance.push_back(bytes.size());
    for (const BakedLampFace& face : model.lamp_faces) {
      const Eigen::Array3f& L = model.channels.empty() ? face.radiance : face.by_channel[c];
      for (std::size_t corner = 0; corner < face.outline.size(); ++corner) {
        for (const float l : L) append_bytes(bytes, l);
      }
    }
  }
  about["radiance"] = std::move(radiance);
  page.about["lamps"] = std::move(about);
}

Json parts(const BakedModel& model, const Eigen::Vector3d& low) {
  Json result = Json::array();
  for (const BakedPart& part : model.parts) {
    result.push_back({{"name", part.name},
                      {"material", part.material},
                      {"picture", part.picture},
                      {"is_back", part.is_back},
                      {"first_face", part.first_face},
                      {"face_count", part.face_count}});
    if (!part.sphere) continue;
    result.back()["sphere"] = {{"center", vector_json(model.to_y_up * part.sphere->center - low)},
                               {"radius", part.sphere->radius}};
  }
  return result;
}

Json materials(const BakedModel& model) {
  Json result = Json::array();
  for (const BakedMaterial& material : model.materials) {
    const char* kind = material.is_glass ? "glass" : material.is_mirror ? "mirror" : "matt";
    result.push_back({{"name", material.name}, {"kind", kind}});
  }
  return result;
}

Json cameras(const BakedModel& model, const Eigen::Vector3d& low) {
  Json result = Json::array();
  for (const BakedCamera& baked : model.cameras) {
    const Camera& camera = baked.camera;
    result.push_back({{"name", camera.name},
                      {"position", vector_json(model.to_y_up * camera.position - low)},
                      {"direction", vector_json(model.to_y_up * camera.direction)},
                      {"up", vector_json(model.to_y_up * camera.up)},
                      {"fov_degrees", camera.fov_degrees},
                      {"near", camera.near_distance},
                      {"aspect", static_cast<double>(camera.width) / camera.height},
                      {"exposure", baked.scale}});
    if (camera.projection == Projection::orthographic) {
      result.back()["view_width"] = camera.view_width;
    }
  }
  return result;
}

Json scale_of(const LuxRange& range) {
  return {{"low", range.low}, {"high", range.high}};
}

// Y of red, green and blue, of which white has 1.
Json luminance_weights(const Bands& bands) {
  const auto weights = shown_bands(bands).xyz.row(1).eval();
  return {weights[0], weights[1], weights[2]};
}

Json false_colors_of(const BakedModel& model, const LuxRange& range) {
  constexpr int entries = 256;
  std::string palette;
  for (int i = 0; i < entries; ++i) {
    for (const float c : false_color(static_cast<float>(i) / (entries - 1))) {
      palette += fmt::format("{:02x}", static_cast<int>(255.0f * c + 0.5f));
    }
  }
  // The page's radiance is linear RGB for every set of bands.
  const auto luminance = luminous_rows(model.radiance, shown_bands(model.bands));
  return {{"illuminance", scale_of(range)},
          {"luminance", scale_of(lux_range(luminance))},
          {"palette", std::move(palette)}};
}

/// Choices of light that shows as grey: the first one, and the colours of black bodies.
Json white_of(const WhitePoint& white) {
  using Kind = WhitePoint::Kind;
  std::set<double> temperatures = {2700.0, 3000.0, 3500.0, 4000.0, 5000.0, 6500.0};
  if (white.kind == Kind::black_body) temperatures.insert(white.kelvin);
  Json bodies = Json::array();
  for (const double kelvin : temperatures) {
    bodies.push_back({{"kelvin", kelvin}, {"colour", numbers(colour_of_black_body(kelvin))}});
  }
  const Json first = white.kind == Kind::as_lit      ? Json("as-lit")
                     : white.kind == Kind::automatic ? Json("auto")
                                                     : Json(white.kelvin);
  return {{"first", first}, {"black_bodies", std::move(bodies)}};
}

}  // namespace

PageData page_data(const BakedModel& model, const LuxRange& range, const WhitePoint& white) {
  const Box box = turned_bounds(model);
  PageData page;
  page.about = {{"format", 1},
                {"title", model.title},
                {"version", model.provenance.version},
                {"scene_file", model.provenance.scene_file},
                {"unit_name", model.unit_name},
                {"metres_per_unit", model.metres_per_unit},
                {"relative_units", model.relative_units},
                {"lumens_per_watt", model.bands.lumens_per_watt},
                {"luminance_weights", luminance_weights(model.bands)},
                {"is_spectral", !model.bands.wavelengths_nm.empty()}};
  Json to_scene = Json::array();  // p_scene = to_scene (p_page + origin)
  for (int c = 0; c < 3; ++c) to_scene.push_back(vector_json(model.to_y_up.col(c)));
  page.about["to_scene"] = std::move(to_scene);
  page.about["origin"] = vector_json(box.low);
  page.about["size"] = vector_json(box.high - box.low);
  page.about["vertex_count"] = model.vertex_count();
  page.about["face_count"] = model.face_count();
  append_positions(model, box, page);
  append_faces(model, page);
  page.about["bases"] = append_bases(model, page.bytes);
  if (!model.cues.empty()) page.about["cues"] = cues(model);
  if (!model.lux_within.empty()) {
    page.about["lux_within"] = append_halves(model.lux_within, page.bytes);
  }
  append_pictures(model, page);
  append_sky(model, page);
  append_lamps(model, box, page);
  page.about["parts"] = parts(model, box.low);
  page.about["materials"] = materials(model);
  page.about["cameras"] = cameras(model, box.low);
  page.about["false_colors"] = false_colors_of(model, range);
  page.about["white"] = white_of(white);
  if (model.year) page.about["year"] = page_year(model, page.bytes);
  return page;
}

std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return result;
}

std::string base64(const std::string& bytes) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      group = group << 8 | (b < count ? static_cast<unsigned char>(bytes[i + b]) : 0u);
    }
    for (std::size_t d = 0; d < 4; ++d) {
      text += d <= count ? digits[group >> (18 - 6 * d) & 63] : '=';
    }
  }
  return text;
}

}  // namespace lightwell
