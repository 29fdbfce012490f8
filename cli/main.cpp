// The lightwell command: arguments to options, results to files, exceptions to exit codes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/version.h"
#include "radiosity/processes/mpi_port.h"
#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr const char* recipes =
    R"(lightwell computes the light in a room once, and shows it from everywhere.

  lightwell demo                                         a Cornell box, and a walk through it
  lightwell run cornell/cornell.toml                     solve, and render every camera of the scene
  lightwell solve room.toml -o room.vtp                  solve, and keep the light on all surfaces
  lightwell mesh room.toml -o mesh.vtp                   the patches and elements of 'solve'
  lightwell render room.toml room.vtp -o room.png        a picture: mirrors, glass, exact shadows
  lightwell relight room.vtp --channel desk=0.3 -o dim.vtp
                                                         dim and recolour lamps, without solving
  lightwell view room.toml room.vtp                      walk through it
  lightwell export room.vtp --scene room.toml -o room.html
                                                         a page to walk through in a browser, or
                                                         a baked model: .glb, .ply, .obj
  lightwell probe room.toml room.vtp --points desk.csv -o lux.csv
                                                         irradiance and lux at points
  lightwell report room.toml room.vtp --plane floor@0.75 -o room.html
                                                         lux, uniformity and glare as a page
  lightwell design office.toml --limits limits.toml -o design
                                                         the dimming of least power within limits
  lightwell road street.toml --max-spacing -o street.html
                                                         road lighting by EN 13201
  lightwell daylight office.toml --weather city.epw --plane floor@0.8 -o year
                                                         every hour of a year: DA, sDA, EN 17037
  lightwell compare mine.exr reference.exr               how far two pictures are apart
  lightwell form-factors room.stl -o room.mtx            view factors between facets
  lightwell radiation room.stl --surfaces kelvin.csv -o heats.csv
                                                         radiant heat between surfaces
  lightwell shortwave city.stl --albedo 0.2 --sun 45,180 --direct 800 -o k.csv
                                                         sky view factors, sun on facets
  lightwell info room.toml                               what is in a scene, solution or picture
  lightwell validate                                     known answers, computed on this machine

'lightwell help COMMAND' explains a command. A scene is a .toml file (docs/scene-format.md),
.obj, .ply, .stl, .gltf, .glb, .dae, .fbx, Mitsuba's .xml, RADIANCE's .rad and .rif,
.mgf, POV-Ray's .pov, Honeybee's .hbjson, DIALux's .stf, or View3D's .vs3.
)";

struct NamedCommand {
  const char* name;
  Action (*add)(CLI::App&);
  bool reads_scene = true;
  bool shares_work = false;  // among several processes
};
constexpr std::array<NamedCommand, 21> commands = {{{"run", add_run, true, true},
                                                    {"solve", add_solve, true, true},
                                                    {"mesh", add_mesh},
                                                    {"relight", add_relight, false},
                                                    {"render", add_render, true, true},
                                                    {"probe", add_probe},
                                                    {"view", add_view},
                                                    {"export", add_export},
                                                    {"report", add_report},
                                                    {"design", add_design},
                                                    {"road", add_road, false},
                                                    {"daylight", add_daylight},
                                                    {"compare", add_compare, false},
                                                    {"form-factors", add_form_factors, true, true},
                                                    {"radiation", add_radiation},
                                                    {"shortwave", add_shortwave},
                                                    {"info", add_info},
                                                    {"validate", add_validate, false},
                                                    {"demo", add_demo, false},
                                                    {"completion", add_completion, false},
                                                    {"manual", add_manual, false}}};

/// Help with one blank line between groups, so that it fits a screen.
class TightFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    std::string help = CLI::Formatter::make_help(app, std::move(name), mode);
    for (std::size_t at; (at = help.find("\n\n\n")) != std::string::npos;) help.erase(at, 1);
    return help;
  }

  /// Drops CLI11's lists of needed and excluded options: descriptions hold these conditions, and
  /// the lists would break the lines.
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    for (const char* mark : {" Needs:", " Excludes:"}) {
      text.resize(std::min(text.size(), text.find(mark)));
    }
    return text;
  }
};

void add_common(CLI::App& app, CommonOptions& options) {
  const std::string group = "Everywhere";
  app.add_flag("--quiet", options.quiet, "no progress, notes or report")->group(group);
  app.add_flag("--json", options.json, "one JSON object on standard output")->group(group);
  app.add_flag("--verbose", options.verbose, "also print the effective options")->group(group);
  app.add_option("--threads", options.threads, "number of threads (default: one per core)")
      ->type_name("N")
      ->check(whole_number(0, 1024))
      ->group(group);
  // The words are searched, since --json may follow --version.
  const auto versions = [&options] {
    const bool json = std::ranges::count(options.command_line, "--json") > 0;
    return json ? version_json().dump(2) : version_text();
  };
  app.set_version_flag("--version", versions, "versions of the program and of its libraries")
      ->group(group);
  app.set_help_flag("-h,--help", "this text")->group(group);
}

void add_reading(CLI::App& command, CommonOptions& options) {
  command
      .add_flag("--strict", options.strict,
                "refuse a scene of which something is left out, approximated or missing")
      ->group("Everywhere");
  command
      .add_flag("--inside-folder", options.inside_folder,
                "refuse a scene that names files outside of its folder")
      ->group("Everywhere");
}

int wrong_usage(const std::string& sentence, const std::string& command = {}) {
  print_error(fmt::format("error: {}\n'lightwell{} --help' lists the options.\n", sentence,
                          command.empty() ? "" : " " + command));
  return exit_wrong_usage;
}

// The first word that is not an option, unless it is a known command.
std::optional<std::string> unknown_command(const std::vector<std::string>& words,
                                           const std::vector<std::string>& known) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--threads") {
      ++i;
    } else if (word.empty() || word[0] != '-') {
      if (std::find(known.begin(), known.end(), word) == known.end()) return word;
      return std::nullopt;
    }
  }
  return std::nullopt;
}

// CLI11's message; for an unknown option, a message that suggests the nearest known option.
std::string usage_sentence(const CLI::ParseError& error, const CLI::App& app,
                           const CLI::App& command) {
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return error.what();
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::vector<std::string> unknown = app.remaining(true);
  for (const std::string& word : unknown) {
    if (word.rfind("-", 0) == 0) {
      return fmt::format("there is no option '{}'.{}", word, did_you_mean(word, known));
    }
  }
  return fmt::format("'{}' is one argument too many", fmt::join(unknown, "' '"));
}

int fail(ExitCode code, const std::string& sentence) {
  print_error(fmt::format("error: {}\n", plain_lines(sentence)));
  return code;
}

// `code`, unless what was printed does not reach its destination.
int with_all_written(int code) {
  // CLI11 prints help and versions to std::cout. Either way errno is that of the write that failed.
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return fail(exit_failed, fmt::format("standard output could not be written: {}",
                                       std::generic_category().message(errno != 0 ? errno : EIO)));
}

// The end of a command that an exception has ended.
struct Failure {
  ExitCode code;
  std::string sentence{};  // to be printed as it is
  std::string reason{};    // for the first process
};

// Failure by the exception that is being handled.
Failure failure() {
  const auto with_reason = [](ExitCode code, const std::string& reason) {
    return Failure{code, fmt::format("error: {}\n", plain_lines(reason)), reason};
  };
  try {
    throw;
  } catch (const InputError& error) {
    return with_reason(exit_bad_input, error.what());
  } catch (const InterruptedWith& interrupted) {
    return {exit_interrupted, fmt::format("{}\n", interrupted.what()), interrupted.what()};
  } catch (const Interrupted& interrupted) {
    return {exit_interrupted, "interrupted; nothing is left half-written\n", interrupted.what()};
  } catch (const std::bad_alloc&) {
    return with_reason(
        exit_failed,
        "not enough memory; a larger --max-patch-size or a smaller picture needs less");
  } catch (const std::exception& error) {
    return with_reason(exit_failed, error.what());
  }
}

struct CommandAction {
  Action run{};
  const char* name = "";
  bool shares_work = false;  // among several processes
};

// The processes that mpirun started for this command; null if there is only this one.
std::unique_ptr<Processes> join(const CommandAction& action) {
  auto port = join_processes();
  if (!port) return nullptr;
  auto processes = std::make_unique<Processes>(std::move(port));
  if (action.shares_work) return processes;
  const std::string sentence = fmt::format(
      "'{}' runs in one process; start it without mpirun (only run, solve, render and form-factors "
      "share work among processes)",
      action.name);
  processes->close(sentence, true);
  throw InputError(sentence);
}

int act(const CommandAction& action, const CommonOptions& options) {
  Console console(options);
  std::unique_ptr<Processes> processes;
  int code = exit_done;
  Failure failed{exit_done};
  try {
    processes = join(action);
    console.set_processes(processes.get());
    if (processes) processes->require_same("the version", LIGHTWELL_VERSION);
    const ThreadLimit limit(options.threads);
    code = with_all_written(action.run(console));
  } catch (const std::exception&) {
    failed = failure();
    code = failed.code;
    console.finish_phase();
    print_error(failed.sentence);
  }
  if (!processes) return code;
  processes->close(failed.reason, failed.code == exit_bad_input);
  // mpirun ends with the code of the first process, unless another has one of its own.
  return processes->is_first() ? code : exit_done;
}

// The words of a command line in which "help" and "help COMMAND" are "" and "COMMAND --help".
std::vector<std::string> without_help_command(std::vector<std::string> words) {
  if (words.size() < 2 || words[1] != "help") return words;
  words.erase(words.begin() + 1);
  if (words.size() > 1) words.insert(words.begin() + 2, "--help");
  return words;
}

int run_program(int argc, char** argv) {
  CommonOptions options;
  options.command_line = without_help_command({argv, argv + argc});
  if (options.command_line.empty()) options.command_line = {"lightwell"};
  CLI::App app("Radiosity with a ray-traced second pass.", "lightwell");
  add_common(app, options);
  app.require_subcommand(0, 1);
  app.formatter(std::make_shared<TightFormatter>());
  app.get_formatter()->column_width(36);

  std::map<const CLI::App*, CommandAction> actions;
  std::vector<std::string> names;
  for (const NamedCommand& named : commands) {
    CLI::App* const command = app.add_subcommand(named.name);
    actions[command] = {named.add(*command), named.name, named.shares_work};
    add_common(*command, options);
    command->get_option("--version")->group("");  // CLI11: hidden, so that the help fits a screen
    if (named.reads_scene) add_reading(*command, options);
    names.push_back(named.name);
  }
  if (const auto word = unknown_command(options.command_line, names)) {
    return wrong_usage(
        fmt::format("there is no command '{}'.{}", *word, did_you_mean(*word, names)));
  }

  try {
    // CLI11 takes the words from the last to the first, without the program.
    app.parse(
        std::vector<std::string>(options.command_line.rbegin(), options.command_line.rend() - 1));
  } catch (const CLI::Success& success) {
    return with_all_written(app.exit(success));  // --help and --version
  } catch (const CLI::ParseError& error) {
    const auto parsed = app.get_subcommands();
    const CLI::App& at = parsed.empty() ? app : *parsed.front();
    return wrong_usage(usage_sentence(error, app, at), parsed.empty() ? "" : at.get_name());
  }
  const auto parsed = app.get_subcommands();
  if (parsed.empty()) {
    fmt::print("{}", recipes);
    return with_all_written(exit_done);
  }
  return act(actions.at(parsed.front()), options);
}

}  // namespace
}  // namespace lightwell

int main(int argc, char** argv) {
  if (lightwell::is_first_by_launcher()) {
    lightwell::catch_interrupts();
  } else {
    lightwell::ignore_interrupts();
    lightwell::be_silent();
  }
  try {
    return lightwell::run_program(argc, argv);
  } catch (const std::exception& error) {
    return lightwell::fail(lightwell::exit_failed, error.what());
  }
}
