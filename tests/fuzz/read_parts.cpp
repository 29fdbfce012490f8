// Targets of the files that scenes, pictures and measurements are made of.
#include "radiosity/solution/cues.h"
#include "raytrace/pictures/image.h"
#include "raytrace/readings/probe.h"
#include "scene/errors.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/pictures/environment_file.h"
#include "scene/io/pictures/picture_mean.h"
#include "scene/io/spectrum_file.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {
namespace {

void place(const LuminaireFile& luminaire) {
  constexpr double half = 0.5;
  beam_angle(*luminaire.web, 0.0, half);
  luminaire_notes(luminaire);
  const Bands bands = rgb_bands();
  Lamp lamp;
  place_luminaire(luminaire, bands, constant_spectrum(bands, 1.0f), lamp);
}

}  // namespace

void read_ies_luminaire(std::string_view bytes) {
  place(read_luminaire(input_file("lamp.ies", bytes)));
}

void read_ldt_luminaire(std::string_view bytes) {
  place(read_luminaire(input_file("lamp.ldt", bytes)));
}

void read_tm33_luminaire(std::string_view bytes) {
  const auto path = input_file("lamp.xml", bytes);
  is_luminaire_file(path);
  place(read_luminaire(path));
}

void read_png_or_jpeg(std::string_view bytes) {
  read_picture(bytes, PictureCode::srgb, "picture");
  picture_mean(bytes, PictureCode::linear, "picture");
}

// Environments and pictures to compare have readers of their own.
void read_exr_picture(std::string_view bytes) {
  const auto path = input_file("picture.exr", bytes);
  try {
    read_exr(path, ExrChannels::all);
  } catch (const InputError&) {
    read_environment_map(path);
    return;
  }
  read_environment_map(path);
}

void read_hdr_picture(std::string_view bytes) {
  read_environment_map(input_file("picture.hdr", bytes));
}

void read_spectrum(std::string_view bytes) {
  const auto path = input_file("spectrum.csv", bytes);
  SpectrumSamples samples;
  try {
    samples = read_spectrum_csv(path, "");
  } catch (const InputError&) {
    samples = read_spectrum_csv(path, "ramp");
  }
  constexpr double low = 500.0, high = 600.0;  // nm
  if (covers(samples, low, high)) mean(samples, low, high);
}

// Cues of a solution with three channels, and the fades between them.
void read_cue_list(std::string_view bytes) {
  RadiositySolution solution;
  for (const char* const name : {"window", "ceiling", "desk"}) {
    solution.channels.push_back({.name = name, .scale = Spectrum::Constant(3, 1.0f)});
    solution.channels.back().energy = BandEnergy::Ones(4, 3);
  }
  solution.bands = rgb_bands();
  const std::vector<Cue> cues = cues_for(solution, read_cues(input_file("cues.toml", bytes)));
  const CueSequence sequence(solution, cues);
  constexpr double share = 0.3;
  sequence.at(share * sequence.seconds());
}

void read_points(std::string_view bytes) {
  constexpr double metres_per_unit = 0.01;
  read_probes(input_file("points.csv", bytes), metres_per_unit);
}

}  // namespace lightwell::fuzz
