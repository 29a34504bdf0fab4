#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/cache_report.h"
#include "apps/commands/commands.h"
#include "apps/exit_code.h"
#include "coupling/errors.h"

namespace spume::apps {
namespace {

namespace fs = std::filesystem;

int info(const std::string& path, bool json) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw coupling::FileError(path + ": no such file or folder");
  Report report;
  report.add("path", path);
  if (fs::is_directory(status))
    describeFolder(path, report);
  else
    describeFile(path, report);
  std::cout << (json ? report.json() : report.text());
  return kDone;
}

}  // namespace

void addInfo(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand("info", "Says what a run's folder or a cache file holds.");
  const auto path = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  verb->add_option("path", *path, "folder of a run, .vdb or .ply file")->required()->type_name("PATH");
  verb->add_flag("--json", *json, "as one JSON object");
  verb->footer(
      "Examples:\n"
      "  spume info out/pouring\n"
      "  spume info out/pouring/bubbles/bubbles.0150.vdb --json");
  verb->callback([path, json, &action] { action = [path, json] { return info(*path, *json); }; });
}

}  // namespace spume::apps
