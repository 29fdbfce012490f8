#include "viewer/window/solution_view.h"

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "mesh/patches/mesh_bounds.h"
#include "raytrace/display/display.h"
#include "viewer/export/baked_channels.h"
#include "viewer/window/vtk_messages.h"

namespace lightwell {
namespace {

/// Texels along a texture's longer side; a window has hardly more pixels.
constexpr int longest_picture = 2048;

DrawnPictures pictures_of(const ViewOptions& options) {
  return DrawnPictures(options.scene ? *options.scene : Scene{}, longest_picture);
}

/// Pictures drawn and averaged, each shifted by a fraction of a pixel. Compared with one picture of
/// sixteen times the pixels, text and lines keep their size, and neither the driver's largest
/// picture nor its memory is a limit. The shifts are a Hammersley set: sixteen different offsets in
/// x and in y smooth edges along rows and columns, and gaps thinner than a pixel, as well as
/// slanted edges. A regular grid turns such gaps into dotted lines.
constexpr int samples_of_pixel = 16;

/// Offset of a sample from the pixel's centre, in pixels.
Eigen::Vector2d sample_offset(int sample) {
  int turned = 0;  // the sample's four bits in reverse order
  for (int bit = 0; bit < 4; ++bit) turned |= ((sample >> bit) & 1) << (3 - bit);
  return (Eigen::Vector2d(sample, turned).array() + 0.5) / samples_of_pixel - 0.5;
}

/// Linear light of each sRGB byte: the inverse of srgb_encode.
std::array<float, 256> srgb_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const float s = static_cast<float>(i) / 255.0f;
    table[i] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
  }
  return table;
}

/// sRGB bytes of `sums` / `passes` (linear light). Row 0 of the result is on top; VTK's is at the
/// bottom.
std::vector<std::uint8_t> encode(const std::vector<float>& sums, int width, int height,
                                 int passes) {
  std::vector<std::uint8_t> picture;
  picture.reserve(sums.size());
  const std::ptrdiff_t stride = std::ptrdiff_t{3} * width;
  for (int y = height - 1; y >= 0; --y) {
    const auto row = sums.begin() + y * stride;
    std::transform(row, row + stride, std::back_inserter(picture), [&](float sum) {
      return static_cast<std::uint8_t>(255.0f * srgb_encode(sum / static_cast<float>(passes)) +
                                       0.5f);
    });
  }
  return picture;
}

}  // namespace

SolutionView::SolutionView(const SolvedScene& solved, const ViewOptions& options)
    : solved_(&solved),
      scene_(options.scene),
      materials_(options.materials),
      given_range_(options.lux_range),
      given_measure_(options.measure),
      has_relative_units_(options.relative_units),
      caster_(solved.mesh),
      kinds_(kinds_with_all_on(solved, options.materials)),  // lamps may be switched on
      irradiance_(solved.solution.irradiance()),
      radiance_(shown_radiance(solved, options.materials)),
      drawn_(pictures_of(options)),
      lux_(vertex_illuminance(solved.solution)),
      bounds_(mesh_bounds(solved.mesh)),
      up_axis_(guess_up_axis(options.cameras, bounds_)),
      spheres_(fine_round_shapes(solved.mesh)),
      actor_(solved.mesh, spheres_, kinds_, radiance_, drawn_),
      sky_(scene_ ? effective_sky(*scene_, solved.mesh) : std::nullopt),
      drawn_lamps_(scene_ ? DrawnLamps(*scene_, caster_) : DrawnLamps()),
      renderer_(vtkSmartPointer<vtkRenderer>::New()),
      legend_(text_scale_of(options)),
      isolux_levels_(options.isolux) {
  if (options.camera) {
    start_camera_ = *options.camera;
  } else if (!options.cameras.empty()) {
    start_camera_ = options.cameras.front();
  } else {
    start_camera_ = find_start(caster_, kinds_, radiance_, up_axis_, options.width, options.height);
  }
  if (options.from_outside) {
    start_camera_ =
        frame_all(bounds_, start_camera_.direction, up_axis_, options.width, options.height);
  }
  if (!drawn_.all().empty()) picture_gain_ = picture_gains(solved.mesh, drawn_);
  actor_.add_to(renderer_);
  if (sky_) outside_.emplace(*sky_).add_to(renderer_);
  if (!drawn_lamps_.faces().empty()) lamps_.emplace(drawn_lamps_).add_to(renderer_);
  isolux_.add_to(renderer_);
  legend_.add_to(renderer_);
  renderer_->SetBackground(0.0, 0.0, 0.0);
  look_.camera = start_camera_;
  look_.white = options.white;
  look_ = metered(look_, start_camera_);
  look_.exposure_ev = options.exposure_ev;
  look_.mesh = options.mesh;
  look_.unlit = !options.look_through && !options.from_outside;
  look_.illuminance = options.illuminance;
  look_.measure = options.measure;
  look_.scaling = options.lux_classes ? Scaling::classes : Scaling::given;
  look_.interpolation_error = options.interpolation_error;
  look_.isolux = !options.isolux.empty();
  lux_range_ = given_measure_ == Measure::illuminance && given_range_
                   ? *given_range_
                   : fitted(Measure::illuminance);
  if (look_.measure != Measure::illuminance) fit_other();
  actor_.show_mesh(look_.mesh);
  actor_.show_unlit(look_.unlit);
  apply_legend();
  apply_camera();
  apply_colors();
  apply_isolux();
}

SolutionView::~SolutionView() = default;

vtkRenderer* SolutionView::renderer() const {
  return renderer_;
}

Eigen::Array3f display_scale(const Look& look) {
  const double scale = look.metered_scale * std::exp2(look.exposure_ev);
  return static_cast<float>(scale) * white_balance(look.white, look.incident);
}

Look SolutionView::metered(Look look, const Camera& camera) const {
  const Metered found =
      meter_view(caster_, kinds_, {irradiance_, radiance_}, solved_->solution.bands, camera, sky());
  look.metered_scale = found.scale;
  look.incident = found.incident;
  return look;
}

void SolutionView::set_look(const Look& look) {
  const bool recolor = (display_scale(look) != display_scale(look_)).any() ||
                       look.illuminance != look_.illuminance || look.measure != look_.measure ||
                       look.scaling != look_.scaling ||
                       look.interpolation_error != look_.interpolation_error;
  look_ = look;
  if (look.measure != Measure::illuminance && (!other_range_ || look.measure != other_measure_)) {
    fit_other();
  }
  actor_.show_mesh(look.mesh);
  actor_.show_unlit(look.unlit);
  apply_legend();
  if (recolor) apply_colors();
  apply_camera();
  apply_isolux();
}

std::vector<double> SolutionView::isolux_levels() const {
  if (!isolux_levels_.empty()) return isolux_levels_;
  if (lux_range_.is_even()) {
    std::vector<double> steps = scale_steps(lux_range_);
    std::erase(steps, 0.0);
    return steps;
  }
  std::vector<double> levels;
  for (double power = std::pow(10.0, std::floor(std::log10(lux_range_.low)));
       power <= lux_range_.high; power *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double level = factor * power;
      if (level > lux_range_.low && level < lux_range_.high) levels.push_back(level);
    }
  }
  return levels;
}

// Isolux lines are computed when first shown.
void SolutionView::apply_isolux() {
  if (look_.isolux && isolux_is_stale_) {
    // Share of the diagonal that keeps the lines in front of walls in the depth buffer.
    constexpr double lift = 1e-3;
    isolux_.set(solved_->mesh, spheres_, kinds_, lux_, radiance_, isolux_levels(),
                lift * bounds_.diagonal());
    isolux_is_stale_ = false;
  }
  isolux_.show(look_.isolux);
  isolux_.look_from(caster_, kinds_, look_.camera, {.unlit = look_.unlit});
}

void SolutionView::light_changed() {
  irradiance_ = solved_->solution.irradiance();
  radiance_ = shown_radiance(*solved_, materials_);
  lux_ = vertex_illuminance(solved_->solution);
  if (outside_) {
    sky_ = effective_sky(*scene_, solved_->mesh);
    outside_->set_sky(*sky_);
  }
  isolux_is_stale_ = true;
  apply_colors();
  apply_isolux();
}

void SolutionView::follow(const SolvedScene& other) {
  solved_ = &other;
  light_changed();
}

void SolutionView::light_arrived() {
  kinds_ = element_kinds(solved_->mesh, solved_->solution.direct_irradiance, materials_);
  light_changed();
  actor_.set_shapes(solved_->mesh, kinds_, radiance_);
  if (given_range_ && given_measure_ == Measure::illuminance) return;
  lux_range_ = fitted(Measure::illuminance);
  apply_legend();
  if (look_.illuminance) apply_colors();
  isolux_is_stale_ = isolux_levels_.empty();
  apply_isolux();
}

void SolutionView::apply_lamps() {
  if (!lamps_) return;
  // Lamps have neither irradiance nor interpolation error.
  const bool is_luminance = look_.illuminance && look_.measure == Measure::luminance;
  lamps_->show(!look_.interpolation_error && (!look_.illuminance || is_luminance));
  const Bands& bands = solved_->solution.bands;
  const BandArray L = drawn_lamps_.radiance(solved_->mesh, radiance_, solved_->mesh.source_scale);
  std::vector<char> is_drawn;
  for (std::size_t f = 0; f < drawn_lamps_.faces().size(); ++f) {
    const bool is_lit = (L.row(static_cast<Eigen::Index>(f)) > 0.0f).any();
    is_drawn.push_back(is_lit || drawn_lamps_.faces()[f].shines ? 1 : 0);
  }
  lamps_->set_colors(is_luminance ? false_colors(luminous_rows(L, bands), measured_range())
                                  : display_colors(L, bands, display_scale(look_)),
                     is_drawn);
}

void SolutionView::apply_colors() {
  apply_lamps();
  // The sky has neither irradiance nor interpolation error.
  if (outside_) outside_->show(!look_.interpolation_error && !look_.illuminance);
  if (look_.interpolation_error) return actor_.set_colors(error_colors(*solved_), {});
  if (shows_classes()) return actor_.set_classes(lux_);
  if (look_.illuminance) {
    return actor_.set_colors(false_colors(measured(look_.measure), measured_range()), {});
  }
  const Bands& bands = solved_->solution.bands;
  const Eigen::Array3f scale = display_scale(look_);
  if (outside_) outside_->expose(bands, scale);
  std::vector<std::uint8_t> codes;
  if (picture_gain_.size() > 0) codes = light_codes(radiance_ * picture_gain_, bands, scale);
  actor_.set_colors(display_colors(radiance_, bands, scale), codes);
}

std::vector<float> SolutionView::measured(Measure measure) const {
  if (measure == Measure::luminance) return luminous_rows(radiance_, solved_->solution.bands);
  if (measure == Measure::illuminance) return lux_;
  return unshot_.empty() ? std::vector<float>(lux_.size(), 0.0f) : unshot_;
}

bool SolutionView::shows_classes() const {
  return look_.illuminance && !look_.interpolation_error && look_.measure == Measure::illuminance &&
         look_.scaling == Scaling::classes;
}

LuxRange SolutionView::fitted(Measure measure) const {
  const std::vector<float> values = measured(measure);
  const BandArray column =
      Eigen::Map<const Eigen::ArrayXf>(values.data(), static_cast<Eigen::Index>(values.size()));
  const Image seen = coarse_picture(caster_, kinds_, column, look_.camera, metering_width);
  const std::vector<float> in_view(seen.radiance.data(),
                                   seen.radiance.data() + seen.radiance.size());
  const bool is_lit = std::ranges::any_of(in_view, [](float value) { return value > 0.0f; });
  return lux_range(is_lit ? in_view : values);
}

void SolutionView::fit_other() {
  const bool is_given = given_range_ && look_.measure == given_measure_;
  other_measure_ = look_.measure;
  other_range_ = is_given ? *given_range_ : fitted(look_.measure);
}

void SolutionView::fit_range() {
  if (look_.measure == given_measure_) given_range_.reset();
  if (look_.measure == Measure::illuminance) {
    lux_range_ = fitted(Measure::illuminance);
    isolux_is_stale_ = isolux_levels_.empty();
  } else {
    fit_other();
  }
  apply_legend();
  if (look_.illuminance) apply_colors();
  apply_isolux();
}

LuxRange SolutionView::measured_range() const {
  const bool is_lux = look_.measure == Measure::illuminance || !other_range_;
  LuxRange range = is_lux ? lux_range_ : *other_range_;
  constexpr double three_decades = 1e-3;
  if (look_.scaling == Scaling::linear) range.low = 0.0;
  if (look_.scaling == Scaling::logarithmic && range.is_even()) {
    range.low = three_decades * range.high;
  }
  return range;
}

void SolutionView::set_unshot(const Eigen::ArrayXf& unshot) {
  const PatchMesh& mesh = solved_->mesh;
  unshot_.assign(static_cast<std::size_t>(mesh.vertex_count()), 0.0f);
  std::vector<float> patches(unshot_.size(), 0.0f);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const auto v = static_cast<std::size_t>(mesh.corners[e][c]);
      unshot_[v] += unshot[mesh.patch[e]];
      patches[v] += 1.0f;
    }
  }
  for (std::size_t v = 0; v < unshot_.size(); ++v) unshot_[v] /= std::max(1.0f, patches[v]);
  if (look_.illuminance && look_.measure == Measure::unshot) {
    fit_other();
    apply_legend();
    apply_colors();
  }
}

void SolutionView::apply_legend() {
  if (look_.interpolation_error) {
    return legend_.set({{.range = {.low = 0.1, .high = 10.0}, .unit = "%"}});  // of error_colors()
  }
  if (!look_.illuminance) return legend_.set({});
  const char* const unit = look_.measure == Measure::illuminance ? "lx"
                           : look_.measure == Measure::luminance ? "cd/m\u00b2"
                                                                 : "lm/m\u00b2";
  legend_.set({{.range = measured_range(),
                .unit = has_relative_units_ ? "relative" : unit,
                .classes = shows_classes()}});
}

void SolutionView::apply_camera() {
  const Camera& camera = look_.camera;
  const double size = bounds_.diagonal();
  vtkCamera* eye = renderer_->GetActiveCamera();
  eye->SetPosition(camera.position.data());
  const Eigen::Vector3d target = camera.position + size * camera.direction;
  eye->SetFocalPoint(target.data());
  eye->SetViewUp(camera.up.data());
  const bool is_parallel = camera.projection == Projection::orthographic;
  eye->SetParallelProjection(is_parallel);
  if (is_parallel) {
    eye->SetParallelScale(0.5 * camera.view_width * camera.height /
                          camera.width);  // half its height
  } else {
    eye->SetUseHorizontalViewAngle(true);
    eye->SetViewAngle(camera.fov_degrees);
  }
  eye->SetWindowCenter(2.0 * camera.shift.x(), 2.0 * camera.shift.y());  // of -1 to 1
  // The depth range covers the bounding sphere. From inside, the near plane is as near as a depth
  // buffer of 24 bits affords.
  const Eigen::Vector3d way = 0.5 * (bounds_.low + bounds_.high) - camera.position;
  const double to_center = is_parallel ? way.dot(camera.direction) : way.norm();
  const double nearest = std::max({to_center - 0.51 * size, 5e-4 * size, camera.near_distance});
  const double farthest = std::max(to_center + 0.51 * size, 2.0 * nearest);
  // The resolution of a depth buffer near the eye depends on the near plane alone, so a far dome
  // costs nothing. At 10 times the farthest distance the dome is behind all surfaces up to 84
  // degrees from the line of sight.
  constexpr double dome = 10.0;
  if (outside_) outside_->place(camera.position, dome * farthest);
  eye->SetClippingRange(nearest, outside_ ? 1.1 * dome * farthest : farthest);
}

std::vector<std::uint8_t> draw_offscreen(const SolutionView& view, int width, int height) {
  const VtkMessages messages;
  vtkNew<vtkRenderWindow> window;
  window->OffScreenRenderingOn();
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  window->AddRenderer(view.renderer());
  const std::size_t count = std::size_t{3} * width * height;
  const std::array<float, 256> linear = srgb_table();
  std::vector<float> sums(count, 0.0f);
  vtkNew<vtkUnsignedCharArray> pixels;
  vtkCamera* eye = view.renderer()->GetActiveCamera();
  const Eigen::Vector2d middle(eye->GetWindowCenter());
  for (int sample = 0; sample < samples_of_pixel; ++sample) {
    const Eigen::Vector2d offset = sample_offset(sample);
    // Window coordinates span 2 in x and in y.
    eye->SetWindowCenter(middle.x() + 2.0 * offset.x() / width,
                         middle.y() + 2.0 * offset.y() / height);
    window->Render();
    const int* drawn = window->GetActualSize();
    if (drawn[0] == width && drawn[1] == height) {
      window->GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
    }
    if (static_cast<std::size_t>(pixels->GetNumberOfValues()) != count) {
      throw std::runtime_error(
          "the graphics driver could not draw the picture off screen; try a smaller size");
    }
    const unsigned char* bytes = pixels->GetPointer(0);
    for (std::size_t i = 0; i < count; ++i) sums[i] += linear[bytes[i]];
  }
  eye->SetWindowCenter(middle.x(), middle.y());
  window->RemoveRenderer(view.renderer());
  return encode(sums, width, height, samples_of_pixel);
}

}  // namespace lightwell
