// A picture and a walk through it, made by an installation without a file of the user's.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/demo_scenes.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct DemoScene {
  const char* name;
  const std::string_view& text;
};
constexpr std::array<DemoScene, 3> demos{
    {{"cornell", demo_scenes::cornell},
     {"cornell-mirror-block", demo_scenes::cornell_mirror_block},
     {"cornell-spheres", demo_scenes::cornell_spheres}}};

struct DemoArguments {
  std::string scene = "cornell", output = "lightwell-demo";
  bool no_window = false;
};

std::vector<std::string> demo_names() {
  std::vector<std::string> names;
  for (const DemoScene& demo : demos) names.emplace_back(demo.name);
  return names;
}

// Carries out another command of the program, with these arguments.
int carry_out(Action (*add)(CLI::App&), std::vector<std::string> arguments, Console& console) {
  CLI::App command;
  const Action action = add(command);
  std::ranges::reverse(arguments);  // CLI11 takes the last word first
  command.parse(arguments);
  return action(console);
}

bool has_display() {
#ifdef LIGHTWELL_VIEWER
  const char* const display = std::getenv("DISPLAY");
  return display && *display != '\0';
#else
  return false;
#endif
}

// Writes the scene, unless its file exists: that may have been edited.
void write_scene(const DemoArguments& arguments, const fs::path& file, Console& console) {
  if (fs::exists(file)) {
    console.say(fmt::format("'{}' is there already and is used as it stands.", file.string()));
    return;
  }
  for (const DemoScene& demo : demos) {
    if (arguments.scene == demo.name) write_whole(file, {demo.text});
  }
}

int demonstrate(const DemoArguments& arguments, Console& console) {
  const OutputFolder folder(arguments.output);
  const fs::path scene = folder / (arguments.scene + ".toml");
  const fs::path solution = folder / "solution.vtp";
  write_scene(arguments, scene, console);
  const int code = carry_out(add_run, {scene.string(), "-o", arguments.output}, console);
  if (code != exit_done) return code;
  stop_if_interrupted();
  if (!arguments.no_window && has_display()) {
    return carry_out(add_view, {scene.string(), solution.string()}, console);
  }
  console.say(fmt::format(
      "To walk through it:  lightwell view {0} {1}\nTo hand it over:     lightwell export {1} "
      "--scene {0} -o room.html\nTo change it, edit {0} and run this command again.",
      scene.string(), solution.string()));
  return code;
}

}  // namespace

Action add_demo(CLI::App& command) {
  const auto arguments = std::make_shared<DemoArguments>();
  command.description(
      "Solves and renders a Cornell box and opens it in a window; needs no file. The scene file "
      "that\n"
      "it writes is yours to edit.");
  command
      .add_option("--scene", arguments->scene,
                  fmt::format("{} (default cornell)", fmt::join(demo_names(), ", ")))
      ->type_name("NAME")
      ->check(one_of("scene", demo_names()));
  command
      .add_option("-o,--output", arguments->output,
                  "folder for the scene and the results (lightwell-demo)")
      ->type_name("DIR");
  command.add_flag("--no-window", arguments->no_window, "stop after the picture");
  command.footer("Example: lightwell demo --scene cornell-spheres");
  return [arguments](Console& console) { return demonstrate(*arguments, console); };
}

}  // namespace lightwell
