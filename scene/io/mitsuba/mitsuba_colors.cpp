#include "scene/io/mitsuba/mitsuba_colors.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "scene/black_body.h"
#include "scene/errors.h"
#include "scene/io/mitsuba/mitsuba_transform.h"
#include "scene/io/spectrum_file.h"
#include "scene/io/text_file.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

constexpr int deepest_texture = 32;  // textures of textures
const BandEdges rgb_edges = {{600.0, 700.0}, {500.0, 600.0}, {400.0, 500.0}};

Spectrum grey(double value) {
  return Spectrum::Constant(3, static_cast<float>(value));
}

Spectrum spectrum_of(const Eigen::Array3d& rgb) {
  return rgb.cast<float>();
}

// Means over the RGB bands; the spectrum is constant beyond its first and last sample.
Spectrum band_means(const MitsubaNode& node, SpectrumSamples samples) {
  for (std::size_t i = 1; i < samples.values.size(); ++i) {
    if (!(samples.wavelengths_nm[i] > samples.wavelengths_nm[i - 1])) {
      node.fail(fmt::format("has the wavelength {} after {}; wavelengths must rise",
                            samples.wavelengths_nm[i], samples.wavelengths_nm[i - 1]));
    }
  }
  if (samples.values.empty()) node.fail("has no samples");
  if (samples.wavelengths_nm.front() > rgb_edges.back()[0]) {
    samples.wavelengths_nm.insert(samples.wavelengths_nm.begin(), rgb_edges.back()[0]);
    samples.values.insert(samples.values.begin(), samples.values.front());
  }
  if (samples.wavelengths_nm.back() < rgb_edges.front()[1]) {
    samples.wavelengths_nm.push_back(rgb_edges.front()[1]);
    samples.values.push_back(samples.values.back());
  }
  Spectrum result(3);
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = rgb_edges[static_cast<std::size_t>(k)];
    result[k] = static_cast<float>(mean(samples, low, high));
  }
  return result;
}

// Samples of an attribute such as "400:0.1, 500:0.2".
SpectrumSamples samples_in_place(const MitsubaNode& node, std::string text) {
  for (char& c : text) {
    if (c == ':') c = ' ';
  }
  const auto numbers = parse_numbers(node, text);
  if (numbers.size() % 2 != 0) node.fail("has a wavelength without a value");
  SpectrumSamples samples;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    samples.wavelengths_nm.push_back(numbers[i]);
    samples.values.push_back(numbers[i + 1]);
  }
  return samples;
}

// Samples of a file with a wavelength (nm) and a value on each line; # begins a comment.
SpectrumSamples samples_of_file(const std::filesystem::path& path) {
  const TextFile file(path);
  SpectrumSamples samples;
  file.for_each_line([&](int line, std::string_view text) {
    text = text.substr(0, text.find('#'));
    const std::string_view first = next_word(text);
    if (first.empty()) return;
    const auto wavelength = parse_finite(first), value = parse_finite(next_word(text));
    if (!wavelength || !value) file.fail(line, "this is no wavelength (nm) followed by a value");
    samples.wavelengths_nm.push_back(*wavelength);
    samples.values.push_back(*value);
  });
  return samples;
}

// Mitsuba 0.5 and 0.6 use "gamma", 2 and 3 "raw".
PictureCode code_of(const MitsubaNode& bitmap) {
  const bool is_linear = bitmap.boolean_or("raw", false) || bitmap.number_or("gamma", 0.0) == 1.0;
  return is_linear ? PictureCode::linear : PictureCode::srgb;
}

}  // namespace

Spectrum MitsubaColors::share_or(const MitsubaNode& owner, std::string_view property,
                                 float otherwise, Pixels pixels) {
  const Spectrum values = positive(owner, property, pixels).value_or(grey(otherwise));
  if ((values > 1.0f).any()) {
    remarks_.add(fmt::format("'{}' exceeds 1 and was cut off there in", property), owner.label());
  }
  return values.min(1.0f);
}

Spectrum MitsubaColors::positive_or(const MitsubaNode& owner, std::string_view property,
                                    float otherwise) {
  return positive(owner, property).value_or(grey(otherwise));
}

std::optional<Spectrum> MitsubaColors::positive(const MitsubaNode& owner, std::string_view property,
                                                Pixels pixels) {
  const MitsubaNode* node = owner.property(property);
  if (!node) return std::nullopt;
  const Spectrum values = read(*node, pixels, 0);
  if (!values.isFinite().all()) node->fail("is too large a number");
  if (!(values >= 0.0f).all()) {
    node->fail(fmt::format("is {}; it must be at least 0", values.minCoeff()));
  }
  return values;
}

// The texture of a property, inside any number of scale textures; nullptr if neither bitmap nor
// checkerboard.
const MitsubaNode* MitsubaColors::texture_node(const MitsubaNode& owner,
                                               std::string_view property) const {
  const MitsubaNode* given = owner.property(property);
  if (!given) return nullptr;
  const MitsubaNode* node = &tree_.resolved(*given);
  for (int depth = 0; node->type == "scale" && depth < deepest_texture; ++depth) {
    const auto inner = tree_.children(*node, "texture");
    if (inner.empty()) return nullptr;
    node = inner.front();
  }
  const bool is_texture = node->tag == "texture" || node->tag == "spectrum";
  return is_texture && (node->type == "bitmap" || node->type == "checkerboard") ? node : nullptr;
}

std::optional<MitsubaTexture> MitsubaColors::texture(const MitsubaNode& owner,
                                                     std::string_view property, Pixels pixels) {
  const MitsubaNode* node = texture_node(owner, property);
  if (!node) return std::nullopt;
  auto result = node->type == "bitmap" ? bitmap(*node, pixels) : checkerboard(*node, pixels);
  if (!result) return std::nullopt;
  const Spectrum factor = factor_of(owner, property, *node, pixels);
  if ((factor > 1.0f).any()) {
    // Only texels above 1 after scaling are cut off.
    const Texture& picture = *result->texture.image.picture;
    if ((factor * picture.largest() > 1.0f).any()) {
      remarks_.add(fmt::format("'{}' exceeds 1 and was cut off there in", property), owner.label());
    }
    result->texture.image.picture = std::make_shared<const Texture>(picture.mapped(
        [&](const Eigen::Array3f& texel) -> Eigen::Array3f { return (factor * texel).min(1.0f); }));
    result->texture.factor = Spectrum::Ones(3);
    result->mean = (factor * result->mean).min(1.0f);
  } else {
    result->texture.factor = factor;
    result->mean *= factor;
  }
  return result;
}

// Product of the scale textures around the texture `node` of a property.
Spectrum MitsubaColors::factor_of(const MitsubaNode& owner, std::string_view property,
                                  const MitsubaNode& node, Pixels pixels) {
  const MitsubaNode* scale = &tree_.resolved(*owner.property(property));
  Spectrum factor = Spectrum::Ones(3);
  for (; scale != &node; scale = tree_.children(*scale, "texture").front()) {
    factor *= part_or(*scale, "scale", 1.0f, pixels, 0) * part_or(*scale, "value", 1.0f, pixels, 0);
  }
  if (!(factor >= 0.0f).all()) owner.fail(fmt::format("has a negative scale of '{}'", property));
  return factor;
}

std::optional<MitsubaLight> MitsubaColors::light(const MitsubaNode& owner,
                                                 std::string_view property) {
  const MitsubaNode* node = texture_node(owner, property);
  if (!node) return std::nullopt;
  Spectrum factor = factor_of(owner, property, *node, Pixels::all);
  SurfaceTexture image;
  if (node->type == "bitmap") {
    const auto picture = light_picture_of(*node);
    if (!picture) return std::nullopt;
    factor *= picture->brightest;
    image = laid_on(*node, picture->color);
  } else {
    const float brightest = brightest_of_checkerboard(*node);
    factor *= brightest;
    image = checkerboard(*node, Pixels::all, brightest).texture.image;
  }
  if (!factor.isFinite().all()) owner.fail(fmt::format("has too large a scale of '{}'", property));
  Spectrum mean = factor;
  mean.head<3>() *= image.picture->mean();
  return MitsubaLight{.texture = {.image = std::move(image), .factor = factor}, .mean = mean};
}

bool MitsubaColors::is_bitmap(const MitsubaNode& owner, std::string_view property) const {
  const MitsubaNode* node = texture_node(owner, property);
  return node && node->type == "bitmap";
}

std::optional<Mask> MitsubaColors::mask(const MitsubaNode& owner, std::string_view property) {
  const MitsubaNode* node = texture_node(owner, property);
  if (!node || node->type != "bitmap") return std::nullopt;
  const auto picture = picture_of(*node, PictureCode::linear);
  if (!picture) return std::nullopt;
  return Mask{.image = laid_on(*node, picture->alpha ? picture->alpha : picture->color)};
}

std::optional<Relief> MitsubaColors::relief(const MitsubaNode& owner) {
  const auto textures = tree_.children(owner, "texture");
  if (textures.empty()) owner.fail("holds no texture");
  double scale = owner.number_or("scale", 1.0);
  const MitsubaNode* node = &tree_.resolved(*textures.front());
  for (int depth = 0; node->type == "scale" && depth < deepest_texture; ++depth) {
    scale *= number_or(*node, "scale", 1.0) * number_or(*node, "value", 1.0);
    const auto inner = tree_.children(*node, "texture");
    if (inner.empty()) node->fail("holds no texture");
    node = &tree_.resolved(*inner.front());
  }
  if (node->type != "bitmap") {
    owner.fail(fmt::format("has a texture of the plugin '{}'; relief is read from a bitmap alone",
                           node->type));
  }
  const bool is_normal_map = owner.type == "normalmap";
  const double most = is_normal_map ? most_relief_scale : most_relief_depth;
  if (!(std::abs(scale) <= most)) {
    owner.fail(fmt::format("has the scale {}; give one between {} and {}", scale, -most, most));
  }
  const auto picture = picture_of(*node, is_normal_map ? PictureCode::linear : code_of(*node));
  if (!picture) return std::nullopt;
  const SurfaceTexture image = laid_on(*node, picture->color);
  if (!is_normal_map) return relief_of_heights(image, scale, DepthUnit::metre);
  try {
    return relief_of_normals(image, scale);
  } catch (const InputError& error) {
    node->fail(error.what());
  }
}

SurfaceTexture MitsubaColors::laid_on(const MitsubaNode& node,
                                      std::shared_ptr<const Texture> picture) {
  SurfaceTexture image{.picture = std::move(picture)};
  const auto wrap = [&](const char* property, const std::string& otherwise) {
    return node.string_or(property, otherwise);
  };
  const std::string both = wrap("wrap_mode", "repeat");
  for (const int axis : {0, 1}) {
    const std::string mode = wrap(axis == 0 ? "wrap_mode_u" : "wrap_mode_v", both);
    image.wrap[static_cast<std::size_t>(axis)] = mode == "mirror"  ? TextureWrap::mirror
                                                 : mode == "clamp" ? TextureWrap::clamp
                                                                   : TextureWrap::repeat;
  }
  image.is_smooth = node.string_or("filter_type", "bilinear") != "nearest";
  if (const MitsubaNode* to_uv = node.property("to_uv")) {
    const Eigen::Matrix4d m = read_mitsuba_transform(*to_uv).matrix();
    image.placement << m(0, 0), m(0, 1), m(0, 3), m(1, 0), m(1, 1), m(1, 3);
  }
  const double scale = node.number_or("uvscale", 1.0);
  Eigen::Matrix<double, 2, 3> scaled;
  scaled << node.number_or("uscale", scale), 0.0, node.number_or("uoffset", 0.0), 0.0,
      node.number_or("vscale", scale), node.number_or("voffset", 0.0);
  const Eigen::Vector2d offset = image.placement.leftCols<2>() * scaled.col(2);
  const Eigen::Matrix2d linear = image.placement.leftCols<2>() * scaled.leftCols<2>();
  image.placement.leftCols<2>() = linear;
  image.placement.col(2) += offset;
  return image;
}

std::optional<MitsubaTexture> MitsubaColors::bitmap(const MitsubaNode& node, Pixels pixels) {
  const auto picture = picture_of(node, code_of(node));
  if (!picture) return std::nullopt;
  const bool is_cut = pixels == Pixels::by_opacity;
  return MitsubaTexture{
      .texture = {.image = laid_on(node, picture->shown(is_cut)), .factor = grey(1.0)},
      .mean = spectrum_of(picture->mean_shown(is_cut))};
}

float MitsubaColors::brightest_of_checkerboard(const MitsubaNode& node) {
  return std::max({part_or(node, "color0", 0.4f, Pixels::all, 0).maxCoeff(),
                   part_or(node, "color1", 0.2f, Pixels::all, 0).maxCoeff(), least_light});
}

// A checkerboard as a texture of two by two texels, its colours divided by `brightest`.
MitsubaTexture MitsubaColors::checkerboard(const MitsubaNode& node, Pixels pixels,
                                           float brightest) {
  const Spectrum colors[] = {part_or(node, "color0", 0.4f, pixels, 0) / brightest,
                             part_or(node, "color1", 0.2f, pixels, 0) / brightest};
  std::vector<Texture::Code> texels;
  for (const int square : {0, 1, 1, 0}) {
    for (int c = 0; c < 3; ++c) texels.push_back(Texture::encode(colors[square][c]));
  }
  SurfaceTexture image = laid_on(node, std::make_shared<const Texture>(2, 2, 3, std::move(texels)));
  image.is_smooth = false;
  const Spectrum mean = 0.5f * (colors[0].min(1.0f) + colors[1].min(1.0f));
  return {.texture = {.image = std::move(image), .factor = grey(1.0)}, .mean = mean};
}

double MitsubaColors::number_or(const MitsubaNode& owner, std::string_view property,
                                double otherwise) {
  const MitsubaNode* node = owner.property(property);
  if (!node) return otherwise;
  if (node->tag == "float" || node->tag == "integer") return *owner.number(property);
  const double mean = read(*node, Pixels::all, 0).cast<double>().mean();
  if (!std::isfinite(mean)) node->fail("is too large a number");
  return mean;
}

Spectrum MitsubaColors::read(const MitsubaNode& given, Pixels pixels, int depth) {
  const MitsubaNode& node = tree_.resolved(given);
  if (depth > deepest_texture) node.fail("refers to itself, or is nested beyond all measure");
  const auto known = known_.find({&node, pixels});
  if (known != known_.end()) return known->second;
  const Spectrum values = read_new(node, pixels, depth);
  return known_.emplace(std::pair(&node, pixels), values).first->second;
}

Spectrum MitsubaColors::read_new(const MitsubaNode& node, Pixels pixels, int depth) {
  if (node.tag == "rgb" || node.tag == "color") return read_rgb(node);
  if (node.tag == "srgb") return read_srgb(node);
  if (node.tag == "float" || node.tag == "integer") return grey(node.number_attribute("value"));
  if (node.tag == "spectrum") return read_spectrum(node, pixels, depth);
  if (node.tag == "blackbody") return read_blackbody(node);
  if (node.tag == "texture") return read_texture(node, pixels, depth);
  node.fail("is no number, colour, spectrum or texture");
}

Spectrum MitsubaColors::read_rgb(const MitsubaNode& node) const {
  const std::string* value = node.attribute("value");
  if (!value) node.fail("lacks the attribute 'value'");
  if (value->starts_with('#')) return read_srgb(node);
  const auto numbers = parse_numbers(node, *value);
  if (numbers.size() == 1) return grey(numbers[0]);
  if (numbers.size() != 3) node.fail(fmt::format("has {} numbers; give three", numbers.size()));
  return spectrum_of({numbers[0], numbers[1], numbers[2]});
}

// sRGB values "#rrggbb", or three numbers in [0,1].
Spectrum MitsubaColors::read_srgb(const MitsubaNode& node) const {
  const std::string* value = node.attribute("value");
  if (!value) node.fail("lacks the attribute 'value'");
  Eigen::Array3d code;
  if (value->starts_with('#')) {
    unsigned hex = 0;
    const auto [end, error] =
        std::from_chars(value->data() + 1, value->data() + value->size(), hex, 16);
    if (value->size() != 7 || error != std::errc() || end != value->data() + value->size()) {
      node.fail(fmt::format("has '{}', which is no colour; write #rrggbb", *value));
    }
    code = Eigen::Array3d(hex >> 16, hex >> 8 & 255, hex & 255) / 255.0;
  } else {
    const auto numbers = parse_numbers(node, *value);
    if (numbers.size() != 3) node.fail(fmt::format("has {} numbers; give three", numbers.size()));
    code = {numbers[0], numbers[1], numbers[2]};
  }
  return spectrum_of(code.unaryExpr(&linear_from_srgb));
}

Spectrum MitsubaColors::read_spectrum(const MitsubaNode& node, Pixels pixels, int depth) {
  if (const std::string* name = node.attribute("filename")) {
    return band_means(node, samples_of_file(tree_.file_named(node, *name)));
  }
  if (const std::string* value = node.attribute("value")) {
    if (value->find(':') != std::string::npos) {
      return band_means(node, samples_in_place(node, *value));
    }
    const auto numbers = parse_numbers(node, *value);
    if (numbers.size() == 1) return grey(numbers[0]);
    if (numbers.size() == 3) return spectrum_of({numbers[0], numbers[1], numbers[2]});
    node.fail(fmt::format("has {} numbers; give one, or wavelength:value pairs", numbers.size()));
  }
  if (node.type == "d65")
    return part_or(node, "color", 1.0f, pixels, depth) *
           part_or(node, "scale", 1.0f, pixels, depth);
  if (node.type == "uniform") return part_or(node, "value", 1.0f, pixels, depth);
  if (node.type == "blackbody") return read_blackbody(node);
  if (node.type == "irregular" || node.type == "regular") {
    node.fail("gives its samples in a way that is not read; write value=\"400:0.1, 500:0.2, ...\"");
  }
  return read_texture(node, pixels, depth);
}

Spectrum MitsubaColors::read_blackbody(const MitsubaNode& node) const {
  const std::string* temperature = node.attribute("temperature");
  double kelvin = node.number_or("temperature", 6500.0);
  if (temperature) {
    std::string_view text = trimmed(*temperature);
    if (text.ends_with('K')) text.remove_suffix(1);
    const auto numbers = parse_numbers(node, text);
    if (numbers.size() != 1) node.fail("has a temperature that is no number of kelvins");
    kelvin = numbers[0];
  }
  if (!(kelvin >= 1.0 && kelvin <= 1e6)) node.fail(fmt::format("has {} K; give 1 to 1e6", kelvin));
  const double scale =
      node.attribute("scale") ? node.number_attribute("scale") : node.number_or("scale", 1.0);
  SpectrumSamples samples;
  for (double nm = 400.0; nm <= 700.0; nm += 5.0) {
    samples.wavelengths_nm.push_back(nm);
    samples.values.push_back(scale * black_body_radiance(nm, kelvin));
  }
  return band_means(node, std::move(samples));
}

Spectrum MitsubaColors::part_or(const MitsubaNode& texture, std::string_view property,
                                float otherwise, Pixels pixels, int depth) {
  const MitsubaNode* node = texture.property(property);
  return node ? read(*node, pixels, depth + 1) : grey(otherwise);
}

Spectrum MitsubaColors::read_texture(const MitsubaNode& node, Pixels pixels, int depth) {
  if (node.type == "bitmap") return read_bitmap(node, pixels);
  if (node.type == "checkerboard") {
    remarks_.add("Checkerboards were read as the mean of their colours", node.label());
    return 0.5f * (part_or(node, "color0", 0.4f, pixels, depth) +
                   part_or(node, "color1", 0.2f, pixels, depth));
  }
  if (node.type == "scale") {
    const auto inner = tree_.children(node, "texture");
    const Spectrum base = inner.empty() ? grey(1.0) : read(*inner.front(), pixels, depth + 1);
    return base * part_or(node, "scale", 1.0f, pixels, depth) *
           part_or(node, "value", 1.0f, pixels, depth);
  }
  remarks_.add(fmt::format("Textures of the plugin '{}' were read as a grey of 0.5", node.type),
               node.label());
  return grey(0.5);
}

Spectrum MitsubaColors::read_bitmap(const MitsubaNode& node, Pixels pixels) {
  const auto picture = picture_of(node, code_of(node));
  if (!picture) return grey(0.5);
  remarks_.add("Pictures on surfaces were read as their mean colour",
               node.string_or("filename", ""));
  return spectrum_of(picture->mean_shown(pixels == Pixels::by_opacity));
}

namespace {

// Calls `read` with the path of a bitmap's file and returns the picture; empty, with a remark, if
// the file is missing, damaged or of another format.
template <class Read>
auto read_bitmap_file(const MitsubaTree& tree, const MitsubaNode& node, Remarks& remarks,
                      Read&& read) -> decltype(read(std::filesystem::path())) {
  const std::string name = node.string_or("filename", "");
  if (!name.empty() && !tree.has_file(node, name)) {
    remarks.add("Pictures that are missing became a grey of 0.5, or no mask", name);
    return std::nullopt;
  }
  decltype(read(std::filesystem::path())) picture;
  const bool is_sound =
      remarks.attempt("Pictures that cannot be read became a grey of 0.5, or no mask", name,
                      [&] { picture = read(tree.file_named(node, name)); });
  if (is_sound && !picture) {
    remarks.add("Pictures of a format that is not read became a grey of 0.5, or no mask", name);
  }
  return picture;
}

}  // namespace

std::optional<Picture> MitsubaColors::picture_of(const MitsubaNode& node, PictureCode code) {
  return read_bitmap_file(tree_, node, remarks_, [&](const std::filesystem::path& path) {
    return pictures_.picture(path, code);
  });
}

std::optional<LightPicture> MitsubaColors::light_picture_of(const MitsubaNode& node) {
  return read_bitmap_file(tree_, node, remarks_, [&](const std::filesystem::path& path) {
    return pictures_.light(path, code_of(node));
  });
}

}  // namespace lightwell
