#include "scene/io/interchange/import_trial.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <fstream>

namespace lightwell {
namespace {

constexpr std::int64_t mebibyte = std::int64_t{1} << 20;

// Size of this process' address space in bytes; 0 where the system does not tell.
std::int64_t address_space() {
  std::int64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

template <class Resource>
void set_limit(Resource resource, std::int64_t most) {
  const auto value = static_cast<rlim_t>(most);
  const rlimit limit{.rlim_cur = value, .rlim_max = value};
  setrlimit(resource, &limit);
}

// Sound files take some 15 bytes of memory for each of their bytes, and a second for 50 MB.
void limit_child(std::int64_t bytes) {
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, 5 + bytes / mebibyte);
  if (const std::int64_t present = address_space(); present > 0) {
    set_limit(RLIMIT_AS, present + 1024 * mebibyte + 100 * bytes);
  }
}

// Output of a library or a sanitizer that fails would only confuse the reader of the message.
void silence_child() {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

void set_signals_of_child() {
  for (const int deadly : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGTERM}) {
    std::signal(deadly, SIG_DFL);
  }
  std::signal(SIGINT, SIG_IGN);  // the parent answers the interrupt
}

[[noreturn]] void run_child(const std::function<std::string()>& import, std::int64_t bytes,
                            int answer) {
  set_signals_of_child();
  silence_child();
  limit_child(bytes);
  std::string fault;
  try {
    fault = import();
  } catch (const std::exception& error) {
    fault = error.what();
  } catch (...) {
    fault = "unknown";
  }
  const bool is_told = write(answer, fault.data(), fault.size()) >= 0;
  _exit(is_told ? EXIT_SUCCESS : EXIT_FAILURE);
}

std::string read_all(int pipe_end) {
  std::string all;
  std::array<char, 1024> part{};
  while (true) {
    const ssize_t count = read(pipe_end, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return all;
    all.append(part.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

std::string trial_fault(const std::function<std::string()>& import, std::int64_t bytes) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return "the system grants no pipe to read it safely";
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    run_child(import, bytes, ends[1]);
  }
  close(ends[1]);
  const std::string fault = child > 0 ? read_all(ends[0]) : std::string();
  close(ends[0]);
  if (child < 0) return "the system grants no process to read it safely";
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS) return fault;
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    return "its contents keep the reader busy without end";
  }
  return "its contents contradict each other";
}

}  // namespace lightwell
