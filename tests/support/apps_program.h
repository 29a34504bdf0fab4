#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace spume::apps::test {

/// A folder that vanishes with the test.
class Scratch {
 public:
  Scratch() {
    static int made = 0;
    path_ = std::filesystem::path(::testing::TempDir()) /
            ("spume_" + std::to_string(getpid()) + "_" + std::to_string(made++));
    std::filesystem::create_directories(path_);
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this / name;
  }
  /// Number of files in it.
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string contentsOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Outcome {
  int code = -1;
  std::string output, errors;  ///< what was printed to standard output and standard error
};

/// Runs the program with arguments as a shell takes them.
inline Outcome runSpume(const std::string& arguments) {
  const std::string base = ::testing::TempDir() + "spume_printed_" + std::to_string(getpid());
  const std::string command = std::string(SPUME_PROGRAM) + " " + arguments;
  const int status = std::system((command + " >" + base + ".out 2>" + base + ".err").c_str());
  Outcome outcome{WEXITSTATUS(status), contentsOf(base + ".out"), contentsOf(base + ".err")};
  std::filesystem::remove(base + ".out");
  std::filesystem::remove(base + ".err");
  return outcome;
}

/// The program refused with `code` and one line that holds `part`.
inline void expectRefused(const Outcome& outcome, int code, const std::string& part) {
  EXPECT_EQ(outcome.code, code) << outcome.errors;
  EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << " is not in: " << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
}

}  // namespace spume::apps::test
