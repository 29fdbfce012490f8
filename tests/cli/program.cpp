#include "tests/cli/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

namespace lightwell {

Running::Running(const std::filesystem::path& folder, const std::vector<std::string>& arguments)
    : Running(folder, Words{std::vector<std::string>{LIGHTWELL_PROGRAM} + arguments}) {}

std::unique_ptr<Running> Running::command(const std::filesystem::path& folder,
                                          const std::vector<std::string>& words) {
  return std::unique_ptr<Running>(new Running(folder, Words{words}));
}

Running::Running(const std::filesystem::path& folder, const Words& given) {
  const std::string out = said_ / "out", err = said_ / "err";
  std::vector<char*> words;
  std::vector<std::string> copies = given.of;
  for (std::string& copy : copies) words.push_back(copy.data());
  words.push_back(nullptr);

  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("fork failed");
  if (process_ > 0) return;
  // Between fork and exec only async-signal-safe functions may be called.
  const int in = ::open("/dev/null", O_RDONLY);
  const int to_out = ::open(out.c_str(), O_CREAT | O_WRONLY, 0600);
  const int to_err = ::open(err.c_str(), O_CREAT | O_WRONLY, 0600);
  ::dup2(in, 0);
  ::dup2(to_out, 1);
  ::dup2(to_err, 2);
  if (::chdir(folder.c_str()) == 0) ::execv(words[0], words.data());
  ::_exit(127);
}

Running::~Running() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Running::signal(int number) const {
  ::kill(process_, number);
}

std::string Running::err() const {
  return content_of(said_ / "err");
}

std::string Running::out() const {
  return content_of(said_ / "out");
}

Ended Running::wait() {
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return {code, content_of(said_ / "out"), content_of(said_ / "err")};
}

Ended run_lightwell(const std::filesystem::path& folder,
                    const std::vector<std::string>& arguments) {
  return Running(folder, arguments).wait();
}

std::string small_room() {
  return content_of(LIGHTWELL_TEST_DATA "/small_room.toml");
}

std::string small_room_with(const std::string& tables) {
  std::string text = small_room();
  text.insert(text.find("[[cameras]]"), tables);
  return text;
}

std::string unit_cube() {
  std::string obj;
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(i & 1) + " " + std::to_string((i >> 1) & 1) + " " +
           std::to_string((i >> 2) & 1) + "\n";
  }
  obj += "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
  return obj;
}

std::vector<std::string> quick() {
  return {"--max-patch-size", "1", "--rays", "64", "--gather-rays", "32"};
}

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace lightwell
