#pragma once

#include <atomic>
#include <cstdlib>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "radiosity/processes/processes.h"

/// Processes that are threads of the test: messages without MPI.
namespace lightwell::local_ports {

/// Messages to each process that it has not received.
class Boxes {
 public:
  explicit Boxes(int size) : of_(static_cast<std::size_t>(size)) {}

  int size() const { return static_cast<int>(of_.size()); }
  void put(int to, Message message) {
    const std::lock_guard lock(mutex_);
    of_[static_cast<std::size_t>(to)].push_back(std::move(message));
  }
  std::optional<Message> take(int rank, int tag) {
    const std::lock_guard lock(mutex_);
    auto& box = of_[static_cast<std::size_t>(rank)];
    for (auto at = box.begin(); at != box.end(); ++at) {
      if (tag != MessagePort::any_tag && at->tag != tag) continue;
      Message message = std::move(*at);
      box.erase(at);
      return message;
    }
    return std::nullopt;
  }

 private:
  std::mutex mutex_{};
  std::vector<std::deque<Message>> of_;
};

class LocalPort : public MessagePort {
 public:
  LocalPort(Boxes& boxes, int rank) : boxes_(boxes), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return boxes_.size(); }
  void send(int to, int tag, SharedBytes bytes) override {
    boxes_.put(to, {.from = rank_, .tag = tag, .bytes = *bytes});
  }
  std::optional<Message> receive(int tag) override { return boxes_.take(rank_, tag); }
  std::int64_t unsent() override { return 0; }
  void finish() override {}
  void abort(int) override { std::abort(); }

 private:
  Boxes& boxes_;
  int rank_;
};

/// Reasons for which the processes ended, by rank; empty without a failure. "dismissed": the first
/// process ended them.
using Ends = std::vector<std::string>;

/// Runs `program` in `size` processes, and ends them as the command does.
inline Ends run_processes(int size, const std::function<void(Processes&)>& program) {
  Boxes boxes(size);
  Ends ends(static_cast<std::size_t>(size));
  const auto run = [&](int rank) {
    Processes processes(std::make_unique<LocalPort>(boxes, rank));
    std::string& end = ends[static_cast<std::size_t>(rank)];
    try {
      program(processes);
    } catch (const Dismissed&) {
      end = "dismissed";
    } catch (const std::exception& error) {
      end = error.what();
    }
    processes.close(end, false);
  };
  std::vector<std::jthread> threads;
  for (int rank = 1; rank < size; ++rank) threads.emplace_back(run, rank);
  run(0);
  threads.clear();
  return ends;
}

}  // namespace lightwell::local_ports
