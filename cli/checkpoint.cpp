#include "cli/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/quoted.h"
#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

constexpr double mebibyte = 1 << 20;

std::string bytes_text(std::int64_t bytes) {
  constexpr double kilobyte = 1e3, megabyte = 1e6;
  const auto size = static_cast<double>(bytes);
  return size < megabyte ? fmt::format("{:.1f} kB", size / kilobyte)
                         : fmt::format("{:.1f} MB", size / megabyte);
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const auto whole = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path), error).lexically_normal();
  };
  return whole(a) == whole(b);
}

}  // namespace

std::optional<double> parse_seconds(const std::string& text) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc()) return std::nullopt;
  std::string unit(end, last);
  if (unit.starts_with(' ')) unit.erase(0, 1);
  static const std::vector<std::pair<std::vector<std::string>, double>> units = {
      {{"", "s", "sec"}, 1.0}, {{"ms"}, 1e-3}, {{"min", "m"}, 60.0}, {{"h"}, 3600.0}};
  constexpr double least = 0.1, most = 86400.0;
  for (const auto& [names, seconds] : units) {
    if (std::find(names.begin(), names.end(), unit) == names.end()) continue;
    const double asked = value * seconds;
    if (!(asked >= least && asked <= most)) return std::nullopt;
    return asked;
  }
  return std::nullopt;
}

void CheckpointArguments::add_to(CLI::App& command, HelpOn help_on, const std::string& group) {
  const std::string more = help_on == HelpOn::all ? group : std::string();  // CLI11: hidden
  command
      .add_option("--checkpoint", file,
                  help_on == HelpOn::all
                      ? "file that keeps finished work, for --resume"
                      : "file that keeps finished work; 'lightwell solve --help' shows its options")
      ->type_name("FILE")
      ->group(group);
  command.add_flag("--resume", resume, "continue from the checkpoint, if there is one")
      ->group(more);
  CLI::Option* const time =
      command
          .add_option_function<std::string>(
              "--every",
              [this](const std::string& text) {
                const auto seconds = parse_seconds(text);
                if (!seconds) {
                  throw CLI::ValidationError(
                      "--every", fmt::format("'{}' is no time from 0.1 s to 24 h; write a number "
                                             "and s, min or h, such as 10s or 2min",
                                             text));
                }
                every = *seconds;
              },
              "time after which finished work is safe on the disk (default 10s)")
          ->type_name("TIME")
          ->group(more);
  command.add_flag("--keep-checkpoint", keep, "keep the checkpoint when the result is written")
      ->group(more);
  command.parse_complete_callback([this, time] {
    if (!file.empty()) return;
    for (const auto& [is_given, name] :
         {std::pair(resume, "--resume"), std::pair(time->count() > 0, "--every"),
          std::pair(keep, "--keep-checkpoint")}) {
      if (is_given) throw CLI::ValidationError(name, "it needs --checkpoint FILE");
    }
  });
}

void CheckpointArguments::add_reuse_to(CLI::App& command, HelpOn help_on) {
  command
      .add_option("--reuse", reuse,
                  "kept checkpoint of an earlier solve of the same geometry, for its form factors")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""))  // no ":FILE" in --help
      ->excludes(command.get_option("--checkpoint"))
      ->group(help_on == HelpOn::all ? "How the light is solved" : "");
}

Checkpoint::Checkpoint(const CheckpointArguments& arguments, const Provenance& of,
                       const std::vector<fs::path>& outputs, Console& console)
    : arguments_(arguments), console_(console) {
  if (!arguments.reuse.empty()) {
    note_input(arguments.reuse);
    journal_ = Journal::of_another_solve(arguments.reuse, of.version);
  }
  const fs::path& file = arguments.file;
  if (file.empty()) return;
  for (const fs::path& output : outputs) {
    if (!is_same_file(file, output)) continue;
    throw InputError(fmt::format(
        "the checkpoint and the result cannot both be '{}'; give another name", file.string()));
  }
  require_writable(file);
  const bool exists = fs::exists(file);
  if (!exists && arguments.resume) {
    console.say(fmt::format("note: there is no checkpoint '{}' yet; starting from the beginning",
                            file.string()));
  }
  journal_ = Journal::open(file, of, arguments.every, arguments.resume);
  if (journal_->found() > 0) {
    console.say(fmt::format("resuming from '{}': {} of finished work", file.string(),
                            bytes_text(journal_->found())));
  }
  if (journal_->torn() > 0) {
    console.say(
        fmt::format("note: the last {} of '{}' are incomplete, since the program was ended; this "
                    "work is repeated",
                    bytes_text(journal_->torn()), file.string()));
  }
}

Progress Checkpoint::watched(Progress progress) {
  if (!journal_ || journal_->is_read_only()) return progress;
  return [this, progress = std::move(progress)](std::string_view phase, double share) {
    const std::string failure = has_warned_ ? std::string() : journal_->failure();
    if (!failure.empty()) {
      has_warned_ = true;
      console_.say(fmt::format(
          "warning: {}. The work continues; what the checkpoint holds so far stays usable",
          failure));
    }
    return progress(phase, share);
  };
}

void Checkpoint::rethrow_stopped() {
  if (!journal_ || journal_->is_read_only()) throw;
  journal_->close();
  const std::string file = arguments_.file.string();
  try {
    throw;
  } catch (const Interrupted&) {
    console_.finish_phase();
    throw InterruptedWith(
        fmt::format("interrupted; finished work is in '{}' ({}). To resume:\n  {}", file,
                    bytes_text(journal_->size()), command_to_resume(console_)));
  } catch (...) {
    // An empty checkpoint would only be refused at the next start without --resume.
    if (!Journal::holds_work(arguments_.file)) {
      journal_->remove();
    } else {
      console_.say(fmt::format("note: finished work is in '{}' ({}); --resume continues from it",
                               file, bytes_text(journal_->size())));
    }
    throw;
  }
}

void Checkpoint::report_reuse(Report& report) {
  report.add("reused", {{"file", arguments_.reuse.string()},
                        {"mb", static_cast<double>(journal_->recalled()) / mebibyte}});
  if (journal_->recalled() == 0) {
    console_.say(fmt::format(
        "warning: nothing in '{}' could be used: the geometry, mirrors, glass, lamps or "
        "form-factor options differ",
        arguments_.reuse.string()));
  } else {
    console_.say_verbose(fmt::format("used {} of '{}'", bytes_text(journal_->recalled()),
                                     arguments_.reuse.string()));
  }
}

void Checkpoint::finish(Report& report, bool is_whole, const std::string& key) {
  if (!journal_) return;
  if (journal_->is_read_only()) {
    report_reuse(report);
    return;
  }
  journal_->close();
  const std::string file = arguments_.file.string(), size = bytes_text(journal_->size());
  report.add(key, {{"file", file},
                   {"mb", static_cast<double>(journal_->size()) / mebibyte},
                   {"resumed_mb", static_cast<double>(journal_->found()) / mebibyte}});
  if (!is_whole) {
    console_.say(fmt::format("finished work is in '{}' ({}). To resume:\n  {}", file, size,
                             command_to_resume(console_)));
  } else if (arguments_.keep) {
    const std::string failure = journal_->failure();
    if (!failure.empty() && !has_warned_) console_.say("warning: " + failure);
    console_.say(fmt::format("kept the checkpoint '{}' ({})", file, size));
  } else {
    journal_->remove();
    console_.say(
        fmt::format("removed the checkpoint '{}' ({}), which is not needed any more", file, size));
  }
}

std::optional<SolvedScene> finished_solution(const CheckpointArguments& arguments,
                                             const Provenance& of, const fs::path& output,
                                             Console& console) {
  std::error_code error;
  if (!arguments.resume || !fs::exists(output, error)) return std::nullopt;
  std::optional<SolvedScene> solved;
  try {
    solved = read_solution(output);
  } catch (const InputError&) {
    return std::nullopt;  // the file is not a solution and will be replaced
  }
  const Provenance& found = solved->solution.provenance;
  if (found.version != of.version || found.scene_hash != of.scene_hash ||
      found.options != of.options || solved->solution.outcome == Outcome::cut_short) {
    return std::nullopt;
  }
  console.say(fmt::format("'{}' is finished: it was solved from this scene with these options",
                          output.string()));
  if (!arguments.keep && fs::exists(arguments.file, error)) {
    // The earlier run ended after it wrote the solution and before it removed the checkpoint.
    try {
      Journal(arguments.file, of).remove();
      console.say(fmt::format("removed the checkpoint '{}', which is not needed any more",
                              arguments.file.string()));
    } catch (const std::runtime_error& other) {
      if (!arguments.pictures_follow) console.say(fmt::format("note: {}", other.what()));
    }
  }
  return solved;
}

std::string command_to_resume(const Console& console) {
  std::string text;
  if (const Processes* processes = console.processes()) {
    text = fmt::format("mpirun -n {}", processes->size());
  }
  bool resumes = false;
  for (const std::string& word : console.options().command_line) {
    if (!text.empty()) text += ' ';
    text += quoted(word);
    resumes = resumes || word == "--resume";
  }
  return resumes ? text : text + " --resume";
}

}  // namespace lightwell
