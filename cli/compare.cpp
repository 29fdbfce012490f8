#include "raytrace/compare.h"

#include <fmt/format.h>

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/report.h"

namespace lightwell {
namespace {

struct Arguments {
  std::string picture, reference, output;
  double full_scale = 0.1;
};

int compare(const Arguments& arguments, Console& console) {
  const Image a = read_exr(arguments.picture), b = read_exr(arguments.reference);
  if (!arguments.output.empty()) require_writable(arguments.output);
  const ImageDifference difference = compare_images(a, b);
  const double white = arguments.full_scale * difference.mean_b;
  if (!arguments.output.empty()) {
    write_png(arguments.output, a.width, a.height, difference_picture(a, b, white),
              {{"software", fmt::format("lightwell {}", LIGHTWELL_VERSION)},
               {"picture", arguments.picture},
               {"reference", arguments.reference},
               {"white", fmt::format("a difference of {:g} W/(m^2 sr)", white)}});
  }
  if (console.options().json) {
    print_json({{"rmse", difference.rmse},
                {"relative_rmse", difference.relative_rmse},
                {"max_difference", difference.max_difference},
                {"mean", difference.mean_a},
                {"reference_mean", difference.mean_b},
                {"perceptual", difference.perceptual}});
    return exit_done;
  }
  fmt::print("relative RMSE   {:.4f} % of the reference's mean\n",
             100.0 * difference.relative_rmse);
  fmt::print("RMSE            {:.6g} W/(m^2 sr)\n", difference.rmse);
  fmt::print("largest         {:.6g} W/(m^2 sr)\n", difference.max_difference);
  fmt::print("means           {:.6g} and {:.6g} (reference)\n", difference.mean_a,
             difference.mean_b);
  fmt::print("tone-mapped     {:.4f} % mean difference\n", 100.0 * difference.perceptual);
  if (!arguments.output.empty()) {
    fmt::print("wrote           {} (white: {:.3g} W/(m^2 sr) and more)\n", arguments.output, white);
  }
  return exit_done;
}

}  // namespace

Action add_compare(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();
  command.description("How much a picture differs from a reference of the same size.");
  command.add_option("picture", arguments->picture, "EXR file")->required()->type_name("A.exr");
  command.add_option("reference", arguments->reference, "EXR file")->required()->type_name("B.exr");
  command.add_option("-o,--output", arguments->output, "picture of the differences, .png")
      ->type_name("FILE")
      ->check(with_extension({".png"}));
  command
      .add_option("--full-scale", arguments->full_scale,
                  "difference drawn white, as a share of the reference's mean (default 0.1)")
      ->type_name("SHARE")
      ->check(positive());
  command.footer("Example: lightwell compare mine.exr reference.exr -o difference.png");
  return [arguments](Console& console) { return compare(*arguments, console); };
}

}  // namespace lightwell
