#include "apps/wedge/wedge_scripts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/reproduce/csv_field.h"
#include "apps/wedge/shell_word.h"

namespace spume::apps {
namespace {

constexpr double kGigabyte = 1024.0 * 1024 * 1024;
constexpr double kMemoryMargin =
    1.5;  ///< estimates of memory are rough, and jobs over their limit are killed

/// Seconds as a scheduler writes them: hours:minutes:seconds.
std::string clockTime(double seconds) {
  const long whole = std::lround(std::ceil(seconds));
  char text[48];
  std::snprintf(text, sizeof text, "%02ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

/// The log of a task as #SBATCH takes it: %a is the number of the task, another % of the path is doubled.
std::string logPath(const std::string& folder) {
  std::string text = "\"";
  for (const char c : folder) text += c == '%' ? "%%" : std::string(1, c);
  return text + "/slurm-%a.log\"";
}

std::string directives(const Wedge& wedge, const SlurmRequest& request) {
  const long memory = std::max(1L, std::lround(std::ceil(kMemoryMargin * request.memoryBytes / kGigabyte)));
  return "#SBATCH --job-name=" + wedge.name() + "\n#SBATCH --array=1-" +
         std::to_string(wedge.variants.size()) +
         "\n#SBATCH --cpus-per-task=" + std::to_string(request.threads) +
         "\n#SBATCH --mem=" + std::to_string(memory) +
         "G\n#SBATCH --time=" + clockTime(request.maxWall + kWallMargin) +
         "\n#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --output=" + logPath(request.folder) +
         "\n";
}

}  // namespace

std::string commandScript(const Wedge& wedge, const std::string& program) {
  std::string text =
      std::string("#!/bin/sh\n") + kWedgeMark + ": " + std::to_string(wedge.variants.size()) +
      " variants of " + wedge.name() +
      ", one after the other.\n"
      "# Options are handed to every run: sh commands.sh --threads 4 --no-preview\n"
      "# Run again, finished variants cost nothing and unfinished ones go on. A variant that fails "
      "does not hold up the\n"
      "# others: the script names it at its end and ends with its exit code. An interruption, or "
      "the end of --max-wall,\n"
      "# ends the script at once with code 130, 143 or 75.\n"
      "cd \"$(dirname \"$0\")\" || exit 4\n"
      "SPUME=${SPUME:-" +
      shellWord(program) +
      "}\n"
      "code=0\n"
      "failed=\n"
      "after() {  # exit code of a run, its folder\n"
      "  case $1 in 75 | 130 | 143) exit \"$1\" ;; esac\n"
      "  [ $code -ne 0 ] || code=$1\n"
      "  failed=\"$failed $2\"\n"
      "}\n\n";
  for (const WedgeVariant& variant : wedge.variants)
    text += "\"$SPUME\" run " + shellWord(variant.folder + "/" + kVariantScene) + " -o " +
            shellWord(variant.folder) + " \"$@\" || after $? " + shellWord(variant.folder) + "\n";
  return text +
         "\n\"$SPUME\" wedge --summary . || [ $code -ne 0 ] || code=$?\n"
         "[ -z \"$failed\" ] || echo \"failed:$failed\" >&2\n"
         "exit $code\n";
}

std::string slurmScript(const Wedge& wedge, const SlurmRequest& request) {
  std::string text = std::string("#!/bin/sh\n") + kWedgeMark + ": a task for each of " +
                     std::to_string(wedge.variants.size()) + " variants of " + wedge.name() + ".\n" +
                     directives(wedge, request) +
                     "# Submit with sbatch. A task stops with a checkpoint before its time is up, is queued "
                     "again and goes on.\n"
                     "cd " +
                     shellWord(request.folder) + " || exit 4\ncase $SLURM_ARRAY_TASK_ID in\n";
  for (std::size_t n = 0; n < wedge.variants.size(); ++n)
    text += std::to_string(n + 1) + ") folder=" + shellWord(wedge.variants[n].folder) + " ;;\n";
  return text + "*) echo \"no variant ${SLURM_ARRAY_TASK_ID:-}: submit with sbatch\" >&2; exit 2 ;;\nesac\n" +
         shellWord(request.program) + " run \"$folder/" + kVariantScene +
         "\" -o \"$folder\" --threads \"${SLURM_CPUS_PER_TASK:-" + std::to_string(request.threads) +
         "}\" --max-wall " + std::to_string(std::lround(std::ceil(request.maxWall))) +
         "s\n"
         "code=$?\n"
         "[ $code -ne 75 ] || scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\"\n"
         "exit $code\n";
}

std::string wedgeTable(const Wedge& wedge) {
  std::string text = "folder";
  for (const std::string& key : wedge.keys) text.append(",").append(csvField(key));
  for (const WedgeVariant& variant : wedge.variants) {
    text.append("\n").append(variant.folder);
    for (const coupling::Override& one : variant.overrides) text.append(",").append(csvField(one.value));
  }
  return text + "\n";
}

}  // namespace spume::apps
