#include "radiosity/solution/mesh_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/radiosity/small_solution.h"

namespace lightwell::mesh_file_test {
namespace {

std::string failure_of(const fs::path& path) {
  try {
    write_mesh(path, small_solution(3).mesh, MeshSides::both, {});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

using MeshFile = SolutionFile;

TEST_F(MeshFile, AFailedWriteNamesTheFileAndLeavesNothing) {
  const std::string message = failure_of(file("no-such-folder/M.vtp"));
  EXPECT_NE(message.find("M.vtp"), std::string::npos) << message;
  EXPECT_EQ(folder_.file_count(), 0);
}

TEST_F(MeshFile, ADiskThatFillsUpLeavesTheOldFile) {
  std::ofstream(file("M.vtp")) << "old";
  // The temporary file is a link to /dev/full, which acts as a full disk.
  fs::create_symlink("/dev/full", file("M.vtp." + std::to_string(::getpid()) + ".part"));
  const std::string message = failure_of(file("M.vtp"));
  EXPECT_NE(message.find("M.vtp"), std::string::npos) << message;
  EXPECT_EQ(contents(file("M.vtp")), "old");
  EXPECT_EQ(folder_.file_count(), 1) << "the temporary is gone";
}

}  // namespace
}  // namespace lightwell::mesh_file_test
