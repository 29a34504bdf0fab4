#include "apps/session_arguments.h"

#include <tbb/global_control.h>

#include <utility>

#include "apps/duration.h"
#include "apps/run_session.h"

namespace spume::apps {

void SessionArguments::addTo(CLI::App& verb, const std::string& defaultFolder) {
  verb.add_option("-o,--output", output, "folder for caches and pictures; default " + defaultFolder)
      ->type_name("DIR");
  verb.add_option("--threads", threads, "default: one per core; results do not depend on it")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  verb.add_option("--max-wall", maxWall, "stop with a checkpoint and exit code 75 after e.g. 3h or 90m")
      ->check(CLI::Validator(durationProblem, "TIME"));
  verb.add_flag("--restart", restart, "start anew and remove what an earlier run left in the folder");
  verb.add_flag("--no-preview", noPreview, "no picture per frame");
}

int SessionArguments::run(coupling::Scene scene, const std::string& defaultFolder) const {
  SessionOptions session;
  session.scene = std::move(scene);
  if (noPreview) session.scene.output.preview = false;
  session.folder = output.empty() ? defaultFolder : output;
  session.restart = restart;
  session.threads = threads > 0 ? threads : allowedThreads();
  if (!maxWall.empty()) session.maxWall = parseDuration(maxWall);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, session.threads);
  return runSession(session);
}

}  // namespace spume::apps
