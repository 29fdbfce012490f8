#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/report.h"
#include "radiosity/journal/journal.h"

namespace lightwell {

/// Whether and where finished work is kept, as asked for on the command line.
struct CheckpointArguments {
  std::filesystem::path file{};  ///< empty: nowhere
  double every = 10.0;           ///< seconds
  bool resume = false, keep = false;
  std::filesystem::path reuse{};  ///< the kept checkpoint of another solve; empty: none

  /// Adds --checkpoint FILE, --every TIME, --resume and --keep-checkpoint.
  enum class HelpOn { all, first };  ///< which of them --help shows
  void add_to(CLI::App& command, HelpOn help_on,
              const std::string& group = "How the light is solved");
  /// Adds --reuse FILE, after those.
  void add_reuse_to(CLI::App& command, HelpOn help_on);
};

/// Seconds: "10s", "2 min", "1.5h", "90"; nothing for what is none or not from 0.1 s to a day.
std::optional<double> parse_seconds(const std::string& text);

/// What is left of a solve or a picture that is stopped, and how people hear of it.
class Checkpoint {
 public:
  /// Opens what was asked for, or does nothing. Throws InputError if a file is there and was not
  /// asked to be gone on with, or does not serve; std::runtime_error if it cannot be written.
  Checkpoint(const CheckpointArguments& arguments, const Provenance& of,
             const std::vector<std::filesystem::path>& outputs, Console& console);

  /// Null if none was asked for.
  Journal* journal() { return journal_.get(); }
  /// Also says, once, if the checkpoint cannot be written any more.
  Progress watched(Progress progress);

  /// After an exception of the work: closes the file. Says where the work is kept, and rethrows
  /// what was thrown; an Interrupted says how to go on.
  [[noreturn]] void rethrow_stopped();
  /// The result is written: removes the file, or says that it stays. `key` is its place in JSON.
  void finish(Report& report, const std::string& key = "checkpoint");

 private:
  CheckpointArguments arguments_;
  Console& console_;
  std::unique_ptr<Journal> journal_{};
  bool has_warned_ = false;
};

/// The solution in `output`, if it was asked to go on and there is nothing left to do: it is of the
/// same scene, options and version. Then no checkpoint of it is needed any more, and it is removed;
/// where `pictures_follow`, the file may be theirs, and then it stays.
std::optional<SolvedScene> finished_solution(const CheckpointArguments& arguments,
                                             const Provenance& of,
                                             const std::filesystem::path& output, Console& console,
                                             bool pictures_follow = false);

/// The command as it was typed, with --resume.
std::string command_to_resume(const CommonOptions& options);

}  // namespace lightwell
