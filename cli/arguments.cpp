#include "cli/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/many_lights.h"
#include "cli/memory_size.h"
#include "cli/refinement.h"
#include "mesh/geometry/cut_size.h"
#include "radiosity/effective_options.h"
#include "radiosity/paths/caustic_photons.h"
#include "radiosity/solve_words.h"
#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

CLI::Validator finite() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        const auto value = parsed_number(text);
        return value && std::isfinite(*value) ? std::string()
                                              : fmt::format("'{}' is not a number", text);
      },
      std::string{});
}

std::pair<int, int> parse_size(const std::string& text) {
  int width = 0, height = 0;
  const char* const last = text.data() + text.size();
  const auto [x, bad_width] = std::from_chars(text.data(), last, width);
  if (bad_width == std::errc() && x != last && (*x == 'x' || *x == 'X')) {
    const auto [end, bad_height] = std::from_chars(x + 1, last, height);
    if (bad_height == std::errc() && end == last && width >= 1 && height >= 1 &&
        width <= max_picture_edge && height <= max_picture_edge) {
      return {width, height};
    }
  }
  throw CLI::ValidationError(
      "--size", fmt::format("'{}' is no picture size; write WIDTHxHEIGHT in pixels, such as "
                            "640x480, each from 1 to {}",
                            text, max_picture_edge));
}

// Beginning of the name of a validator of one_of(), which goes on with the names that it accepts.
constexpr std::string_view accepts = "accepts ";

}  // namespace

CLI::Validator one_of(std::string what, std::vector<std::string> known) {
  const std::string name = fmt::format("{}{}", accepts, fmt::join(known, " "));
  return CLI::Validator(
      [what, known](std::string& given) -> std::string {
        if (std::find(known.begin(), known.end(), given) != known.end()) return {};
        return fmt::format("there is no {} '{}'; choose from: {}.{}", what, given,
                           fmt::join(known, ", "), did_you_mean(given, known));
      },
      std::string{}, name);
}

std::vector<std::string> accepted_names(CLI::Option& option) {
  try {
    for (int i = 0;; ++i) {
      const std::string& name = option.get_validator(i)->get_name();
      if (name.starts_with(accepts)) return CLI::detail::split(name.substr(accepts.size()), ' ');
    }
  } catch (const CLI::OptionNotFound&) {  // CLI11 has no number of validators
    return {};
  }
}

void add_scene(CLI::App& command, std::string& scene) {
  command.add_option("scene", scene, fmt::format("scene file: {}", scene_extensions))
      ->required()
      ->type_name("SCENE");
}

CLI::Validator with_extension(std::vector<std::string> extensions) {
  return CLI::Validator(
      [extensions](std::string& file) -> std::string {
        const std::string given = lower_extension(file);
        if (std::find(extensions.begin(), extensions.end(), given) != extensions.end()) return {};
        return fmt::format("'{}' must end in {}", file, fmt::join(extensions, " or "));
      },
      std::string{});
}

void add_solved_scene(CLI::App& command, std::string& scene, std::string& solution) {
  command.add_option("scene", scene, "the scene file the solution was made from")
      ->required()
      ->type_name("SCENE");
  command.add_option("solution", solution, "the solution, .vtp")->required()->type_name("SOLUTION");
}

void add_size(CLI::App& command, std::optional<std::pair<int, int>>& size) {
  command
      .add_option_function<std::string>(
          "--size", [&size](const std::string& text) { size = parse_size(text); },
          "picture size in pixels (default: the camera's)")
      ->type_name("WxH");
}

void add_exposure(CLI::App& command, double& exposure_ev) {
  command
      .add_option("--exposure", exposure_ev,
                  "exposure correction in stops, negative for darker (default 0: automatic)")
      ->type_name("EV")
      ->check(finite());
}

std::vector<std::string> form_factor_method_names() {
  std::vector<std::string> names;
  for (const NamedFormFactorMethod& known : form_factor_methods) names.emplace_back(known.name);
  return names;
}

CLI::Option* add_hemicube_resolution(CLI::App& command, int& resolution) {
  constexpr int finest = 4096;
  return command
      .add_option("--hemicube-resolution", resolution,
                  "cells along an edge of the hemicube's top, even (default 256)")
      ->type_name("N")
      ->check(whole_number(2, finest))
      ->check(CLI::Validator(
          [](std::string& text) {
            return text.find_last_of("02468") + 1 == text.size()
                       ? std::string()
                       : "an even number is needed, not '" + text + "'";
          },
          std::string{}));
}

std::string hemicube_text(const std::string& method, int resolution) {
  return method == "hemicube" ? fmt::format(" --hemicube-resolution {}", resolution) : "";
}

void refuse_beside(const CLI::App& command, const char* option,
                   const std::vector<const char*>& others) {
  for (const char* other : others) {
    if (command.get_option(other)->count() == 0) continue;
    throw CLI::ValidationError(
        option, fmt::format("cannot be combined with {}; give only one of the two", other));
  }
}

void MeshArguments::add_to(CLI::App& command, const std::string& group) {
  command
      .add_option("--max-patch-size", max_patch_size,
                  "longest patch edge in the scene file's unit (default: about 1600 patches)")
      ->type_name("L")
      ->check(positive())
      ->group(group);
  command
      .add_option("--elements-per-patch-edge", mesh.elements_per_patch_edge,
                  "elements along a patch edge, for the detail of shadows (default 2)")
      ->type_name("N")
      ->check(whole_number(1, 64))
      ->group(group);
  command
      .add_option_function<double>(
          "--max-element-size",
          [this, &command](double size) {
            refuse_beside(command, "--max-element-size", {"--elements-per-patch-edge"});
            max_element_size = size;
          },
          "longest element edge in the scene file's unit (default: half a patch)")
      ->type_name("L")
      ->check(positive())
      ->group(group);
  command
      .add_flag("--discontinuity", mesh.discontinuity,
                "cut receivers along discontinuity lines, the bounds of umbra and penumbra")
      ->group(group);
}

MeshOptions MeshArguments::options(const Scene& scene) const {
  MeshOptions options = mesh;
  options.max_patch_size = max_patch_size * scene.metres_per_unit;
  options.max_element_size = max_element_size * scene.metres_per_unit;
  return options;
}

std::string MeshArguments::text(const Scene& scene) const {
  const CutSize cut = cut_size(scene, options(scene));
  const std::string elements =
      max_element_size > 0.0 ? fmt::format("--max-element-size {:.6g}", max_element_size)
                             : fmt::format("--elements-per-patch-edge {}", cut.elements_per_edge);
  return fmt::format("--max-patch-size {:.6g} {}{}", cut.patch_size / scene.metres_per_unit,
                     elements, mesh.discontinuity ? " --discontinuity" : "");
}

void SolveArguments::add_to(CLI::App& command) {
  const std::string group = "How the light is solved";
  mesh.add_to(command, group);
  command
      .add_option("--form-factors", form_factors,
                  "form-factor method: auto (default), ray-cast, hemicube, analytic")
      ->type_name("METHOD")
      ->check(one_of("form-factor method", form_factor_method_names()))
      ->group(group);
  add_hemicube_resolution(command, solve.form_factors.hemicube_resolution)->group(group);
  command
      .add_option("--solver", solver,
                  "solver: auto (default), gauss-seidel, jacobi, sor, southwell, cg, bicgstab, "
                  "gmres; progressive: progressive refinement, without stored form factors")
      ->type_name("METHOD")
      ->check(one_of("solver", solver_names()))
      ->group(group);
  command
      .add_option(
          "--rays", solve.form_factors.rays_per_patch,
          "form-factor rays per patch, a power of two (default 512; fewer for a loose --accuracy)")
      ->type_name("N")
      ->check(power_of_two())
      ->group(group);
  add_refinement(command, solve.refine, group);
  add_memory(command, memory)->group(group);
  command
      .add_option("--gather-rays", solve.gather.rays,
                  "final-gather rays per mesh vertex, a power of two (default 1024, or fewer where "
                  "elements "
                  "leave a larger error)")
      ->type_name("N")
      ->check(power_of_two())
      ->group(group);
  command
      .add_option("--tolerance", solve.solver.tolerance,
                  "relative error of radiosity at which the solver stops (default 1e-5)")
      ->type_name("T")
      ->check(positive())
      ->group(group);
  command
      .add_option("--max-sweeps", solve.solver.max_sweeps,
                  "most sweeps of the solver (default 500)")
      ->type_name("N")
      ->check(whole_number(1, 1000000))
      ->group(group);
  add_many_lights(command, solve, group);
  add_accuracy(command, solve.accuracy, group);
  channels.add_to(command, group);
  look_from.add_to(command, group);
}

SolveOptions SolveArguments::options(const Scene& scene) const {
  SolveOptions options = solve;
  options.mesh = mesh.options(scene);
  options.form_factors.method = form_factor_method(form_factors);
  choose_solver(solver, options);
  options.channels = channels.channels(scene);
  options.view_rays = look_from.rays(scene);
  return options;
}

std::string SolveArguments::text(const Scene& scene) const {
  std::string effort = accuracy_text(solve.accuracy);
  SolveOptions asked = solve;
  asked.mesh = mesh.mesh;
  MeshArguments patches = mesh;
  patches.mesh.auto_patch_count = auto_patch_count(asked);
  if (solve.accuracy && !(solve.refine.tolerance > 0.0)) {
    effort += refinement_text(solve.refine);
  } else if (solve.accuracy && solve.refine.max_elements > 0) {
    effort += fmt::format(" --max-elements {}", solve.refine.max_elements);
  }
  if (!solve.accuracy) {
    effort = refinement_text(solve.refine);
    if (solve.gather.rays > 0) effort += fmt::format(" --gather-rays {}", solve.gather.rays);
  }
  return fmt::format(
      "{}{} --form-factors {}{} --solver {} --rays {} --tolerance {:g} --max-sweeps {}{}{}{}",
      patches.text(scene), effort, form_factors,
      hemicube_text(form_factors, solve.form_factors.hemicube_resolution), solver,
      rays_per_patch(asked), solve.solver.tolerance, solve.solver.max_sweeps,
      many_lights_text(solve), channels.text(), look_from.text());
}

PictureQuality RenderArguments::effective_quality() const {
  PictureQuality result = picture_quality(quality);
  result.shadow_rays = shadow_rays.value_or(result.shadow_rays);
  result.photons = photons.value_or(result.photons);
  result.noise = noise.value_or(result.noise);
  return result;
}

void RenderArguments::add_to(CLI::App& command) {
  const std::string group = "How pictures are made";
  add_size(command, projection.size);
  add_exposure(command, exposure_ev);
  for (const char* name : {"--size", "--exposure"}) command.get_option(name)->group(group);
  projection.add_to(command, group);
  command
      .add_option("--quality", quality,
                  "draft, good (default) or final: shadow rays, photons and noise together; "
                  "options of their own come before it")
      ->type_name("QUALITY")
      ->check(one_of("quality", picture_quality_names()))
      ->group(group);
  command
      .add_option(
          "--pass", pass,
          "auto: light of lamps and sun anew at every pixel, that of the sky and indirect light "
          "where the solution is coarse (default); direct: all direct light anew; gather: indirect "
          "light anew at every pixel; interpolate: all light from the solution; virtual-lights: no "
          "solution needed")
      ->type_name("PASS")
      ->check(one_of("pass", pass_names()))
      ->group(group);
  command
      .add_option("--shadow-rays", shadow_rays,
                  "most shadow rays per emitter and point (default: of the quality, 64)")
      ->type_name("N")
      ->check(whole_number(1, most_shadow_rays))
      ->group(group);
  command
      .add_option("--gather-samples", gather_samples,
                  "final-gather rays per point, for --pass gather (default 256)")
      ->type_name("N")
      ->check(whole_number(1, most_gather_rays))
      ->group(group);
  command
      .add_option("--virtual-lights", virtual_lights,
                  "points that send on light, for --pass virtual-lights (default 4096)")
      ->type_name("N")
      ->check(whole_number(1, most_virtual_lights))
      ->group(group);
  command
      .add_option("--photons", photons,
                  "photons for the caustics of mirrors and glass (default: of the quality, "
                  "524288); 0: caustics "
                  "from the solution's mesh")
      ->type_name("N")
      ->check(whole_number(0, most_photons))
      ->group(group);
  command
      .add_option("--depth", depth,
                  "most mirrors and glass surfaces along a path, at least 128; 0: none")
      ->type_name("N")
      ->check(whole_number(0, deepest_tree))
      ->group(group);
  command
      .add_option("--samples", samples,
                  "most samples of every pixel (default: 256 where gloss is seen or with a lens; "
                  "otherwise only edges are supersampled)")
      ->type_name("N")
      ->check(whole_number(1, SampleOptions::limit))
      ->group(group);
  command
      .add_option_function<std::string>(
          "--noise",
          [this](const std::string& text) {
            const auto share = parse_share(text);
            if (!share) {
              throw CLI::ValidationError(
                  "--noise",
                  fmt::format("'{}' is not a relative error; write a share of a pixel's light from "
                              "0.001% to 100%, such as 2%",
                              text));
            }
            noise = *share;
          },
          "relative standard error at which the sampling of a pixel stops (default: of the "
          "quality, "
          "2%)")
      ->type_name("ERROR")
      ->group(group);
}

RenderOptions RenderArguments::options() const {
  RenderOptions options = picture_options(pass, quality, effective_quality());
  options.gather_rays = gather_samples;
  options.virtual_lights = virtual_lights;
  options.max_depth = depth;
  options.sampling.most = samples;
  return options;
}

std::string RenderArguments::text() const {
  const PictureQuality chosen = effective_quality();
  std::string text = fmt::format("--pass {} --shadow-rays {}", pass, chosen.shadow_rays);
  if (pass == "gather") text += fmt::format(" --gather-samples {}", gather_samples);
  if (pass == "virtual-lights") text += fmt::format(" --virtual-lights {}", virtual_lights);
  if (pass != "interpolate") text += fmt::format(" --photons {}", chosen.photons);
  if (depth != RenderOptions{}.max_depth) text += fmt::format(" --depth {}", depth);
  if (samples > 0) text += fmt::format(" --samples {}", samples);
  text += projection.text();
  return text + fmt::format(" --noise {:g}%", 100.0 * chosen.noise);
}

}  // namespace lightwell
