#include "raytrace/light_meter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "raytrace/camera_ray.h"
#include "raytrace/display.h"
#include "scene/black_body.h"

namespace lightwell {
namespace {

struct Tone {
  double Y = 0.0;
  Eigen::Array3f rgb = Eigen::Array3f::Zero();
};

// Tones of all pixels whose luminance is positive and finite.
std::vector<Tone> positive_tones(const Image& image, const Bands& bands) {
  std::vector<Tone> result;
  result.reserve(image.radiance.rows());
  for (Eigen::Index i = 0; i < image.radiance.rows(); ++i) {
    const Eigen::Array3f rgb = linear_rgb(bands, image.radiance.row(i).transpose());
    const double Y = luminance(rgb);
    if (Y > 0.0 && std::isfinite(Y)) result.push_back({.Y = Y, .rgb = rgb});
  }
  return result;
}

// The tones within a factor `spread` of the median luminance.
std::vector<Tone> typical_tones(std::vector<Tone> tones) {
  constexpr double spread = 10.0;
  if (tones.empty()) return tones;
  const auto middle = tones.begin() + static_cast<std::ptrdiff_t>(tones.size() / 2);
  std::ranges::nth_element(tones, middle, {}, &Tone::Y);
  const double median = middle->Y;
  std::erase_if(tones,
                [&](const Tone& t) { return t.Y < median / spread || t.Y > median * spread; });
  return tones;
}

// A camera's picture of another width and the same shape.
Camera with_width(const Camera& camera, int width) {
  Camera coarse = camera;
  const double height = static_cast<double>(width) * camera.height / camera.width;
  coarse.width = width;
  coarse.height = std::clamp(static_cast<int>(std::lround(height)), 1, 4 * width);
  coarse.lens_radius = 0.0;
  return coarse;
}

struct PixelRays {
  std::vector<Ray> rays{};
  std::vector<int> pixels{};
};

// The part of each ray that lies behind its hit.
void add_further(const Ray& ray, const ElementHit& hit, int pixel, PixelRays& further) {
  Ray behind = ray;
  behind.origin += hit.t * ray.direction;
  behind.origin_group = hit.facet;
  further.rays.push_back(behind);
  further.pixels.push_back(pixel);
}

}  // namespace

std::optional<double> typical_luminance(const Image& image, const Bands& bands) {
  const std::vector<Tone> tones = typical_tones(positive_tones(image, bands));
  if (tones.empty()) return std::nullopt;
  double sum = 0.0;
  for (const Tone& tone : tones) sum += std::log(tone.Y);
  return std::exp(sum / static_cast<double>(tones.size()));
}

Image white_paper_picture(const ElementCaster& caster, const BandArray& irradiance,
                          std::span<const char> clear, const Camera& camera, int width) {
  constexpr int most_layers = 16;  // panes, backs and dark sides that a ray passes
  const Camera coarse = with_width(camera, width);
  const CameraRays camera_rays(coarse);
  Image image{coarse.width, coarse.height, {}};
  image.radiance = BandArray::Zero(image.width * image.height, irradiance.cols());
  const PatchMesh& mesh = caster.mesh();
  PixelRays all;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      all.rays.push_back(camera_rays.ray(x + 0.5, y + 0.5));
      all.pixels.push_back(y * image.width + x);
    }
  }
  for (int layer = 0; layer < most_layers && !all.rays.empty(); ++layer) {
    std::vector<ElementHit> hits(all.rays.size());
    caster.closest_hits(all.rays, hits);
    PixelRays further;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const ElementHit& hit = hits[i];
      if (hit.facet < 0) continue;
      const bool is_clear =
          hit.element >= 0 && !clear.empty() && clear[static_cast<std::size_t>(hit.element)] != 0;
      const Spectrum E = hit.element >= 0 && !is_clear
                             ? interpolate(mesh, irradiance, hit)
                             : Spectrum(Spectrum::Zero(irradiance.cols()));
      if ((E > 0.0f).any()) {
        image.radiance.row(all.pixels[i]) = (E / std::numbers::pi_v<float>).transpose();
      } else {
        add_further(all.rays[i], hit, all.pixels[i], further);
      }
    }
    all = std::move(further);
  }
  return image;
}

std::optional<IncidentLight> meter_incident_light(const ElementCaster& caster,
                                                  const BandArray& irradiance,
                                                  std::span<const char> clear, const Bands& bands,
                                                  const Camera& camera) {
  constexpr int width = 160;
  const Image paper = white_paper_picture(caster, irradiance, clear, camera, width);
  const std::vector<Tone> tones = typical_tones(positive_tones(paper, bands));
  if (tones.empty()) return std::nullopt;
  double sum = 0.0;
  Eigen::Array3d colour = Eigen::Array3d::Zero();
  for (const Tone& tone : tones) {
    sum += tone.Y;
    colour += tone.rgb.cast<double>();
  }
  return IncidentLight{.exposure = static_cast<double>(tones.size()) / sum,
                       .colour = (colour / sum).cast<float>()};
}

std::optional<double> incident_exposure(const ElementCaster& caster, const BandArray& irradiance,
                                        std::span<const char> clear, const Bands& bands,
                                        const Camera& camera) {
  const auto light = meter_incident_light(caster, irradiance, clear, bands, camera);
  return light ? std::optional(light->exposure) : std::nullopt;
}

Eigen::Array3f colour_of_black_body(double kelvin) {
  const Bands bands = spectral_bands(380.0, 780.0, 80);
  Spectrum power(bands.count());
  for (int k = 0; k < bands.count(); ++k) {
    const double nm = bands.wavelengths_nm[static_cast<std::size_t>(k)];
    power[k] =
        static_cast<float>(black_body_radiance(nm, kelvin) / black_body_radiance(560.0, kelvin));
  }
  const Eigen::Array3f rgb = linear_rgb(bands, power);
  return rgb / static_cast<float>(luminance(rgb));
}

Eigen::Array3f white_balance(const Eigen::Array3f& colour) {
  constexpr float most = 16.0f;
  return colour.max(1.0f / most).inverse();
}

}  // namespace lightwell
