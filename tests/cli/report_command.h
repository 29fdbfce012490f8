#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell {

/// 'lightwell report' of a small room, which is solved before each test.
class ReportCommand : public CommandTest {
 protected:
  void SetUp() override {
    folder.write("room.toml", small_room());
    const Ended solved =
        run(std::vector<std::string>{"solve", "room.toml", "-o", "room.vtp", "--quiet"} + quick());
    ASSERT_EQ(solved.code, 0) << solved.err;
  }
  void expect_refused(const std::vector<std::string>& words, int code,
                      const std::string& sentence) {
    const int files = folder.file_count();
    const Ended ended = run(std::vector<std::string>{"report", "room.toml", "room.vtp"} + words);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_TRUE(says(ended.err, sentence));
    EXPECT_EQ(folder.file_count(), files);
  }
};

}  // namespace lightwell
