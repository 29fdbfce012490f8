#include "radiosity/processes/mpi_port.h"

#include <fmt/format.h>

// The C interface alone.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <climits>
#include <cstdlib>
#include <list>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace lightwell {
namespace {

// Errors of MPI calls end all processes, as MPI does by default. MPI_THREAD_SERIALIZED allows one
// call at a time, which the mutex sees to.
class MpiPort : public MessagePort {
 public:
  MpiPort() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, int tag, SharedBytes bytes) override {
    if (bytes->size() > INT_MAX) {
      throw std::runtime_error(
          fmt::format("a message of {} MB to process {} is longer than MPI allows (2 GB); smaller "
                      "scenes or fewer columns fit",
                      bytes->size() >> 20, to));
    }
    const std::lock_guard lock(mutex_);
    forget_sent();
    Sending& sending = sending_.emplace_back(Sending{.bytes = std::move(bytes)});
    unsent_ += size_of(sending);
    MPI_Isend(sending.bytes->data(), static_cast<int>(sending.bytes->size()), MPI_BYTE, to, tag,
              MPI_COMM_WORLD, &sending.request);
  }

  std::optional<Message> receive(int tag) override {
    const std::lock_guard lock(mutex_);
    int is_there = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, tag == any_tag ? MPI_ANY_TAG : tag, MPI_COMM_WORLD, &is_there,
                &message, &status);
    if (is_there == 0) return std::nullopt;
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    Message received{.from = status.MPI_SOURCE,
                     .tag = status.MPI_TAG,
                     .bytes = Bytes(static_cast<std::size_t>(count))};
    MPI_Mrecv(received.bytes.data(), count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
    return received;
  }

  std::int64_t unsent() override {
    const std::lock_guard lock(mutex_);
    forget_sent();
    return unsent_;
  }

  void finish() override {
    const std::lock_guard lock(mutex_);
    MPI_Finalize();
  }

  void abort(int code) override {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::_Exit(code);
  }

 private:
  struct Sending {
    SharedBytes bytes{};
    MPI_Request request = MPI_REQUEST_NULL;
  };

  // An empty message counts, too.
  static std::int64_t size_of(const Sending& sending) {
    return static_cast<std::int64_t>(sending.bytes->size()) + 1;
  }

  void forget_sent() {
    for (auto at = sending_.begin(); at != sending_.end();) {
      int is_sent = 0;
      MPI_Test(&at->request, &is_sent, MPI_STATUS_IGNORE);
      if (is_sent == 0) {
        ++at;
        continue;
      }
      unsent_ -= size_of(*at);
      at = sending_.erase(at);
    }
  }

  std::mutex mutex_{};
  std::list<Sending> sending_{};  // a list, since requests must stay where they are
  std::int64_t unsent_ = 0;
  int rank_ = 0, size_ = 1;
};

}  // namespace

std::unique_ptr<MessagePort> join_processes() {
  if (!is_started_by_mpi()) return nullptr;
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  auto port = std::make_unique<MpiPort>();
  if (port->size() > 1) {
    if (provided >= MPI_THREAD_SERIALIZED) return port;
    throw std::runtime_error(
        "this MPI library cannot be used from several threads (MPI_THREAD_SERIALIZED); use one "
        "that was built with threads, or start one process");
  }
  port->finish();
  return nullptr;
}

}  // namespace lightwell
