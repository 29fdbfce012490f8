#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"

namespace lightwell {

namespace fs = std::filesystem;

inline void put(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Message of read_solution for a file that must be refused. Also checks that nothing else prints.
inline std::string refusal(const fs::path& path) {
  testing::internal::CaptureStderr();
  std::string message;
  try {
    read_solution(path);
  } catch (const InputError& e) {
    message = e.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  if (!message.empty()) {
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  }
  return message;
}

inline void expect_refused(const fs::path& path, const std::string& reason) {
  const std::string message = refusal(path);
  EXPECT_NE(message.find(reason), std::string::npos) << "message: '" << message << "'";
}

}  // namespace lightwell
