#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Modules and libraries a module must not include (design: apps -> coupling -> {fluid, foam}).
struct Rule {
  std::string module;
  std::vector<std::string> forbidden;
};

const std::vector<Rule> kRules{
    {"fluid", {"foam/", "coupling/", "apps/", "tests/"}},
    {"foam", {"fluid/", "coupling/", "apps/", "tests/", "openvdb/"}},
    {"coupling", {"apps/", "tests/"}},
    {"apps", {"tests/"}},
};

/// What the #include lines of a file name.
std::vector<std::string> includesOf(const fs::path& file) {
  std::vector<std::string> included;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#' || line.find("include", hash) == std::string::npos)
      continue;
    const std::size_t open = line.find_first_of("\"<"), close = line.find_last_of("\">");
    if (open != std::string::npos && close > open)
      included.push_back(line.substr(open + 1, close - open - 1));
  }
  return included;
}

std::vector<fs::path> sourcesOf(const std::string& module) {
  std::vector<fs::path> sources;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SPUME_SOURCE_DIR) / module))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
      sources.push_back(entry.path());
  return sources;
}

}  // namespace

TEST(IncludeDirection, EachModuleUsesOnlyWhatLiesBelowIt) {
  for (const Rule& rule : kRules)
    for (const fs::path& source : sourcesOf(rule.module))
      for (const std::string& included : includesOf(source))
        for (const std::string& forbidden : rule.forbidden)
          EXPECT_FALSE(included.starts_with(forbidden) || included.find("../") != std::string::npos)
              << source << " includes " << included;
}

TEST(IncludeDirection, EveryModuleIsLookedAt) {
  for (const Rule& rule : kRules) EXPECT_FALSE(sourcesOf(rule.module).empty()) << rule.module;
}

TEST(IncludeDirection, EveryHeaderHasAGuard) {
  for (const Rule& rule : kRules)
    for (const fs::path& source : sourcesOf(rule.module)) {
      if (source.extension() != ".h") continue;
      std::ifstream stream(source);
      std::string first;
      std::getline(stream, first);
      EXPECT_EQ(first, "#pragma once") << source;
    }
}
