// Reads a scene of any format that Lightwell knows and prints what is in it: notes of the reader,
// surfaces, materials and luminaires.
#include <cstdio>
#include <exception>

#include "scene/coat.h"
#include "scene/io/read_scene.h"

using namespace lightwell;

int main(int argc, char** argv) try {
  const Scene scene = read_scene(argc > 1 ? argv[1] : "cornell/cornell.toml");
  std::printf("%s: %zu facets, %d bands\n", scene.file.c_str(), scene_facets(scene).size(),
              scene.bands.count());
  for (const std::string& note : scene.notes) std::printf("note: %s\n", note.c_str());

  bool conserves_energy = true;
  for (const Material& material : scene.materials) {
    const Spectrum reflected = material.reflectance + mean_mirrored(material);
    std::printf("material %-16s reflects", material.name.c_str());
    for (const float rho : reflected) std::printf(" %.3f", rho);
    std::printf("%s\n", material.dielectric ? ", clear" : "");
    conserves_energy = conserves_energy && (reflected <= 1.0f).all();
  }

  const char* const unit = scene.relative_units ? "relative units" : "lm";
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[surface.material];
    const double area = surface_area(surface);
    std::printf("surface %-16s %8.4f m2 of %s\n", surface.name.c_str(), area,
                material.name.c_str());
    if (material.is_emitter()) {
      std::printf("luminaire %-14s %8.1f %s from each lit side\n", surface.name.c_str(),
                  area * luminous(scene.bands, material.emission), unit);
    }
  }
  for (const Lamp& lamp : scene.lamps) {
    std::printf("luminaire %-14s %8.1f %s at (%.2f, %.2f, %.2f) m\n", lamp.name.c_str(),
                luminous(scene.bands, lamp_flux(lamp)), unit, lamp.position.x(), lamp.position.y(),
                lamp.position.z());
  }
  return conserves_energy && gives_light(scene) ? 0 : 1;
} catch (const std::exception& error) {  // InputError names file, line, value and remedy
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
