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

/// Options of checkpoints.
struct CheckpointArguments {
  std::filesystem::path file{};  ///< empty: no checkpoint
  double every = 10.0;           ///< seconds after which finished work is safe on the disk
  bool resume = false, keep = false;
  std::filesystem::path reuse{};  ///< the kept checkpoint of another solve; empty: none
  bool pictures_follow = false;   ///< pictures of the solution will use the same file

  enum class HelpOn { all, first };  ///< whether --help shows all options or --checkpoint alone
  /// Adds --checkpoint FILE, --every TIME, --resume and --keep-checkpoint.
  void add_to(CLI::App& command, HelpOn help_on,
              const std::string& group = "How the light is solved");
  /// Adds --reuse FILE. To be called after add_to().
  void add_reuse_to(CLI::App& command, HelpOn help_on);
};

/// Seconds in `text`: "10s", "2 min", "1.5h", "90". Empty if `text` is not a time from 0.1 s to a
/// day.
std::optional<double> parse_seconds(const std::string& text);

/// The journal of a solve or of pictures, from its opening to its removal, with the messages about
/// the checkpoint on the console.
class Checkpoint {
 public:
  /// Opens the checkpoint of `arguments`, or nothing without --checkpoint and --reuse. Throws
  /// - InputError if a file of `outputs` is the checkpoint, if the checkpoint holds work and
  ///   --resume was not given, or if Journal refuses the file (damaged, in use, of another scene,
  ///   other options or another version);
  /// - std::runtime_error if the file cannot be written.
  Checkpoint(const CheckpointArguments& arguments, const Provenance& of,
             const std::vector<std::filesystem::path>& outputs, Console& console);

  /// Null without --checkpoint and --reuse.
  Journal* journal() { return journal_.get(); }
  /// `progress` with one warning on the console if writing the checkpoint fails.
  Progress watched(Progress progress);

  /// Closes the checkpoint while an exception of the work is handled, names its file on the console
  /// and rethrows the exception. An Interrupted becomes an InterruptedWith that holds the command
  /// to resume.
  [[noreturn]] void rethrow_stopped();
  /// Ends the checkpoint once the result is written, and adds its size to the report under `key`.
  /// Removes the checkpoint of a whole result, unless --keep-checkpoint was given; keeps
  /// that of a result that was ended early, and prints the command to resume.
  void finish(Report& report, bool is_whole, const std::string& key = "checkpoint");

 private:
  void report_reuse(Report& report);

  CheckpointArguments arguments_;
  Console& console_;
  std::unique_ptr<Journal> journal_{};
  bool has_warned_ = false;
};

/// The solution in the file `output` if --resume was given and the solution has the scene, options
/// and version of `of`; empty otherwise. Removes a checkpoint of that solve, unless
/// --keep-checkpoint was given. With `pictures_follow`, a checkpoint that does not belong to the
/// solve is taken for one of its pictures, and is kept without a note.
std::optional<SolvedScene> finished_solution(const CheckpointArguments& arguments,
                                             const Provenance& of,
                                             const std::filesystem::path& output, Console& console);

/// The command line with --resume, quoted for a shell; with several processes for `mpirun`.
std::string command_to_resume(const Console& console);

}  // namespace lightwell
