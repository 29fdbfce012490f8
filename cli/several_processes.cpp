#include "cli/several_processes.h"

#include <fmt/format.h>

#include "radiosity/rows/memory_budget.h"
#include "scene/errors.h"

namespace lightwell {

void agree_on(const Provenance& of, const TimeLimit& time, const Console& console) {
  Processes* const processes = console.processes();
  if (!processes) return;
  if (time.seconds() > 0.0) {
    throw InputError(
        "--time is for one process: several would decide by clocks of their own what to leave out; "
        "ask for an --accuracy instead, or start one process");
  }
  processes->require_same("the scene", fmt::format("{:016x}", of.scene_hash));
  processes->require_same("the list of options", of.options);
}

CheckpointArguments of_first(const CheckpointArguments& arguments, const Console& console) {
  return console.is_first() ? arguments : CheckpointArguments{};
}

bool answer_of_first(bool mine, const Console& console) {
  if (!console.processes()) return mine;
  const Bytes answer = console.processes()->from_first({mine ? std::byte{1} : std::byte{0}});
  return answer == Bytes{std::byte{1}};
}

void add_traffic(int patches, const Feedback& feedback) {
  Processes* const processes = feedback.console.processes();
  if (!processes) return;
  const Traffic& own = processes->traffic();
  const Json mine = {{"pieces", own.pieces},
                     {"busy_seconds", own.busy},
                     {"sent_mb", static_cast<double>(own.sent) / (1 << 20)},
                     {"received_mb", static_cast<double>(own.received) / (1 << 20)},
                     {"peak_memory_mb", static_cast<double>(resident_memory().most) / (1 << 20)}};
  Json all = Json::array();
  for (const std::string& text : processes->gather(mine.dump())) all.push_back(Json::parse(text));
  if (!processes->is_first()) return;
  feedback.report.add("processes", std::move(all));
  feedback.report.add("rounds", own.rounds);
  if (processes->size() > patches) {
    feedback.console.say(
        fmt::format("note: {} processes share the work of {} patches; fewer would be as fast",
                    processes->size(), patches));
  }
}

}  // namespace lightwell
