#include "raytrace/display/light_meter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "raytrace/cameras/camera_ray.h"
#include "raytrace/display/display.h"
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

struct PixelRays {
  std::vector<Ray> rays{};
  std::vector<int> pixels{};
};

void add_part_behind(const Ray& ray, const ElementHit& hit, int pixel, PixelRays& further) {
  Ray behind = ray;
  behind.origin += hit.t * ray.direction;
  behind.origin_group = hit.facet;
  further.rays.push_back(behind);
  further.pixels.push_back(pixel);
}

// 1 for each element that is clear or gets no light at any corner.
std::vector<char> clear_or_dark(const PatchMesh& mesh, const BandArray& irradiance,
                                std::span<const char> clear) {
  std::vector<char> passed(static_cast<std::size_t>(mesh.element_count()), 1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (!clear.empty() && clear[i] != 0) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      if ((irradiance.row(mesh.corners[e][c]) > 0.0f).any()) passed[i] = 0;
    }
  }
  return passed;
}

}  // namespace

std::optional<double> typical_luminance(const Image& image, const Bands& bands) {
  const std::vector<Tone> tones = typical_tones(positive_tones(image, bands));
  if (tones.empty()) return std::nullopt;
  double sum = 0.0;
  for (const Tone& tone : tones) sum += std::log(tone.Y);
  return std::exp(sum / static_cast<double>(tones.size()));
}

Image coarse_picture(const ElementCaster& caster, std::span<const char> passed,
                     const BandArray& radiance, const Camera& camera, int width, const Sky* sky) {
  constexpr int most_layers = 16;  // panes, backs and others that a ray passes
  const CameraRays camera_rays(camera);
  const double rows = static_cast<double>(width) * camera.height / camera.width;
  Image image{width, std::clamp(static_cast<int>(std::lround(rows)), 1, 4 * width), {}};
  image.radiance = BandArray::Zero(image.width * image.height, radiance.cols());
  PixelRays all;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto ray = camera_rays.ray_at((x + 0.5) * camera.width / image.width,
                                          (y + 0.5) * camera.height / image.height);
      if (!ray) continue;
      all.rays.push_back(*ray);
      all.pixels.push_back(y * image.width + x);
    }
  }
  for (int layer = 0; layer < most_layers && !all.rays.empty(); ++layer) {
    std::vector<ElementHit> hits(all.rays.size());
    caster.closest_hits(all.rays, hits);
    PixelRays further;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const ElementHit& hit = hits[i];
      const int pixel = all.pixels[i];
      if (hit.facet < 0) {
        if (!sky) continue;
        const Spectrum L = radiance_outside(*sky, all.rays[i].direction.normalized());
        image.radiance.row(pixel) = L.transpose();
      } else if (hit.element < 0 ||
                 (!passed.empty() && passed[static_cast<std::size_t>(hit.element)] != 0)) {
        add_part_behind(all.rays[i], hit, pixel, further);
      } else {
        image.radiance.row(pixel) = interpolate(caster.mesh(), radiance, hit).transpose();
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
  const Image seen = coarse_picture(caster, clear_or_dark(caster.mesh(), irradiance, clear),
                                    irradiance, camera, metering_width);
  const std::vector<Tone> tones = typical_tones(positive_tones(seen, bands));
  if (tones.empty()) return std::nullopt;
  double sum = 0.0;
  Eigen::Array3d colour = Eigen::Array3d::Zero();
  for (const Tone& tone : tones) {
    sum += tone.Y;
    colour += tone.rgb.cast<double>();
  }
  return IncidentLight{.exposure = std::numbers::pi * static_cast<double>(tones.size()) / sum,
                       .colour = (colour / sum).cast<float>()};
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
  constexpr float most = 64.0f;
  return colour.max(1.0f / most).inverse();
}

Eigen::Array3f white_balance(const WhitePoint& white,
                             const std::optional<IncidentLight>& incident) {
  using Kind = WhitePoint::Kind;
  if (white.kind == Kind::black_body) return white_balance(colour_of_black_body(white.kelvin));
  if (white.kind == Kind::automatic && incident) return white_balance(incident->colour);
  return Eigen::Array3f::Ones();
}

}  // namespace lightwell
