#include "raytrace/display/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "radiosity/solve_words.h"

namespace lightwell {
namespace {

struct CompareArguments {
  std::string picture, reference, second_half, output;
  double full_scale = 0.1;
  CompareOptions compare;
  std::optional<double> fail_above;
};

// `value`, or null if it is not finite: JSON has no NaN and no infinity, and a relative difference
// from black is one of them.
Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json json_of(const ImageDifference& difference) {
  Json bands = Json::array();
  for (const BandDifference& band : difference.bands) {
    bands.push_back({{"band", band.band},
                     {"rmse", band.rmse},
                     {"relative_rmse", json_number(band.relative_rmse)},
                     {"max_difference", band.max_difference},
                     {"mean", band.mean_a},
                     {"reference_mean", band.mean_b}});
  }
  return {{"rmse", difference.rmse},
          {"relative_rmse", json_number(difference.relative_rmse)},
          {"max_difference", difference.max_difference},
          {"mean", difference.mean_a},
          {"reference_mean", difference.mean_b},
          {"excluded", difference.excluded},
          {"perceptual", difference.perceptual},
          {"flip", difference.flip},
          {"hdr_flip", difference.hdr_flip},
          {"bands", std::move(bands)}};
}

Json json_of(const HalvesDifference& difference) {
  return {{"rmse", difference.rmse},
          {"relative_rmse", json_number(difference.relative_rmse)},
          {"mean_square", difference.mean_square},
          {"reference_noise", difference.reference_noise},
          {"mean", difference.mean_a},
          {"reference_mean", difference.mean_reference},
          {"excluded", difference.excluded}};
}

void print_excluded(double share) {
  if (share > 0.0) fmt::print("left out        {:.2f} % of the pixels\n", 100.0 * share);
}

void print_difference(const ImageDifference& difference) {
  fmt::print("relative RMSE   {:.4f} % of the reference's mean\n",
             100.0 * difference.relative_rmse);
  if (difference.bands.size() > 1) {
    fmt::print("  by band      ");
    for (const BandDifference& band : difference.bands) {
      fmt::print(" {} {:.4f} %", band.band, 100.0 * band.relative_rmse);
    }
    fmt::print("\n");
  }
  fmt::print("RMSE            {:.6g} W/(m^2 sr)\n", difference.rmse);
  fmt::print("largest         {:.6g} W/(m^2 sr)\n", difference.max_difference);
  fmt::print("means           {:.6g} and {:.6g} (reference)\n", difference.mean_a,
             difference.mean_b);
  print_excluded(difference.excluded);
  fmt::print("FLIP            {:.4f} tone-mapped, {:.4f} at the worst exposures (0 to 1)\n",
             difference.flip, difference.hdr_flip);
  fmt::print("tone-mapped     {:.4f} % mean difference\n", 100.0 * difference.perceptual);
}

void print_difference(const HalvesDifference& difference) {
  fmt::print("relative RMSE   {:.4f} % of the reference's mean, without the references' noise\n",
             100.0 * difference.relative_rmse);
  fmt::print("RMSE            {:.6g} W/(m^2 sr)\n", difference.rmse);
  fmt::print("mean square     {:.6g}{}\n", difference.mean_square,
             difference.mean_square < 0.0 ? " (below 0: less than the noise)" : "");
  fmt::print("reference noise {:.6g} W/(m^2 sr), RMS of the halves' mean\n",
             difference.reference_noise);
  fmt::print("means           {:.6g} and {:.6g} (reference)\n", difference.mean_a,
             difference.mean_reference);
  print_excluded(difference.excluded);
}

// Writes the difference picture; white is `full_scale` times the reference's mean.
void write_difference(const CompareArguments& arguments, const Image& a, const Image& b,
                      double mean) {
  const double white = arguments.full_scale * mean;
  write_png(arguments.output, a.width, a.height, difference_picture(a, b, white),
            {{"software", fmt::format("lightwell {}", LIGHTWELL_VERSION)},
             {"picture", arguments.picture},
             {"reference", arguments.reference},
             {"white", fmt::format("a difference of {:g} W/(m^2 sr)", white)}});
}

int verdict(const CompareArguments& arguments, double relative_rmse, Console& console) {
  if (!arguments.fail_above || relative_rmse <= *arguments.fail_above) return exit_done;
  console.say(
      fmt::format("the relative RMSE of {:.4g} % is above the {:.4g} % that --fail-above "
                  "allows",
                  100.0 * relative_rmse, 100.0 * *arguments.fail_above));
  return exit_failed;
}

template <class Difference>
int print_result(const Difference& difference, const CompareArguments& arguments,
                 Console& console) {
  if (console.options().json) {
    Json json = json_of(difference);
    if (arguments.fail_above) {
      json["fail_above"] = *arguments.fail_above;
      json["passed"] = difference.relative_rmse <= *arguments.fail_above;
    }
    print_json(json);
  } else {
    print_difference(difference);
    if (!arguments.output.empty()) {
      fmt::print("wrote           {} (white: {:.3g} % of the reference's mean and more)\n",
                 arguments.output, 100.0 * arguments.full_scale);
    }
  }
  return verdict(arguments, difference.relative_rmse, console);
}

int compare(const CompareArguments& arguments, Console& console) {
  for (const std::string& file : {arguments.picture, arguments.reference, arguments.second_half}) {
    if (!file.empty()) note_input(file);
  }
  if (!arguments.output.empty()) require_writable(arguments.output);
  const Image a = read_exr(arguments.picture, ExrChannels::bands);
  const Image b = read_exr(arguments.reference, ExrChannels::bands);
  if (arguments.second_half.empty()) {
    const ImageDifference difference = compare_images(a, b, arguments.compare);
    if (!arguments.output.empty()) write_difference(arguments, a, b, difference.mean_b);
    return print_result(difference, arguments, console);
  }
  const Image second = read_exr(arguments.second_half);
  const HalvesDifference difference = compare_with_halves(a, b, second, arguments.compare);
  if (!arguments.output.empty()) {
    Image mean{.width = b.width, .height = b.height};
    mean.radiance = 0.5f * (b.radiance + second.radiance);
    write_difference(arguments, a, mean, difference.mean_reference);
  }
  return print_result(difference, arguments, console);
}

}  // namespace

Action add_compare(CLI::App& command) {
  const auto arguments = std::make_shared<CompareArguments>();
  command.description(
      "Compares a picture with a reference of the same size, or with two noisy references.");
  command.add_option("picture", arguments->picture, "EXR file")->required()->type_name("A.exr");
  command.add_option("reference", arguments->reference, "EXR file")->required()->type_name("B.exr");
  command
      .add_option("second_half", arguments->second_half,
                  "a second reference with independent noise, to exclude the noise of both")
      ->type_name("B2.exr");
  command.add_option("-o,--output", arguments->output, "picture of the differences, .png")
      ->type_name("FILE")
      ->check(with_extension({".png"}));
  command
      .add_option("--full-scale", arguments->full_scale,
                  "difference drawn white, as a share of the reference's mean (default 0.1)")
      ->type_name("SHARE")
      ->check(positive());
  command
      .add_option("--exclude-above", arguments->compare.exclude_above,
                  "leave out pixels whose reference is brighter, such as lamps, W/(m^2 sr)")
      ->type_name("L")
      ->check(positive());
  constexpr int largest_block = 4096;
  command
      .add_option("--block", arguments->compare.block,
                  "compare means over squares of N x N pixels (default 1)")
      ->type_name("N")
      ->check(whole_number(1, largest_block));
  command
      .add_option_function<std::string>(
          "--fail-above",
          [arguments](const std::string& text) {
            arguments->fail_above = parse_share(text);
            if (!arguments->fail_above) {
              throw CLI::ValidationError(
                  "--fail-above",
                  fmt::format("'{}' is no share from 0.001% to 100%, such as 1%", text));
            }
          },
          "exit with code 1 if the relative RMSE is above this error, such as 1%")
      ->type_name("ERROR");
  command.footer(
      "Example: lightwell compare mine.exr reference.exr --exclude-above 5 -o difference.png");
  return [arguments](Console& console) { return compare(*arguments, console); };
}

}  // namespace lightwell
