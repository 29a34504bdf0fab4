#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>

#include "apps/commands/commands.h"
#include "apps/commands/reproduce.h"
#include "apps/exit_code.h"
#include "coupling/simd_path.h"

namespace spume::apps {
namespace {

int complain(const std::exception& error, ExitCode code) {
  std::cerr << "spume: " << error.what() << std::endl;
  return code;
}

/// Runs the chosen verb; every error becomes one message and an exit code.
int perform(const Action& action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    std::cerr << "spume: out of memory; a lower --resolution needs less" << std::endl;
    return kFailed;
  } catch (const std::exception& error) {
    return complain(error, exitCodeOf(error));
  }
}

/// What is wrong with the verb of a command line, or an empty string.
std::string verbProblem(const CLI::App& program, int argc, char** argv) {
  std::string verbs;
  bool known = argc > 1 && argv[1][0] == '-';
  for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; })) {
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
    known = known || (argc > 1 && verb->get_name() == argv[1]);
  }
  if (known) return {};
  return (argc < 2 ? std::string("no verb given") : std::string("unknown verb ") + argv[1]) +
         ": expected one of " + verbs;
}

int parseAndPerform(int argc, char** argv) {
  CLI::App program{"Bubbles and foam in a liquid."};
  program.name("spume");
  program.set_version_flag("--version", std::string(SPUME_VERSION " (") + coupling::kSimdPath + ")");
  program.require_subcommand(1);
  program.footer(
      "`spume VERB --help` explains a verb and gives examples.\n"
      "Exit codes: 0 done, 2 wrong command line or scene, 3 check failed or simulation diverged,\n"
      "4 input/output, 75 stopped by --max-wall, 130/143 interrupted after writing a checkpoint.");
  Action action;
  addRun(program, action);
  addFoam(program, action);
  addCheck(program, action);
  addInfo(program, action);
  addRender(program, action);
  addMeasure(program, action);
  addReproduce(program, action);
  addTrade(program, action);
  addWedge(program, action);
  if (const std::string problem = verbProblem(program, argc, argv); !problem.empty())
    return complain(std::invalid_argument(problem), kUsage);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(error, kUsage);
  }
  return perform(action);
}

/// What was printed may have gone into a file on a full disk: the code says so where nothing worse did.
int codeAfterPrinting(int code) {
  const bool printed = std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (printed) return code;
  std::cerr << "spume: standard output: cannot write" << std::endl;
  return code == kDone ? kInputOutput : code;
}

}  // namespace
}  // namespace spume::apps

int main(int argc, char** argv) {
  return spume::apps::codeAfterPrinting(spume::apps::parseAndPerform(argc, argv));
}
