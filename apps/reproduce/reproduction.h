#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "apps/reproduce/result_table.h"
#include "coupling/scene.h"

namespace spume::apps {

/// What a study may use beside its own settings.
struct StudyContext {
  std::string folder;                  ///< for plots and curves; a study that needs it creates it
  int frames = 0;                      ///< length of a scene's run; 0: as the scene says
  std::string scenes = "data/scenes";  ///< where the scene files lie
  std::string runs = "out/reproduce";  ///< where scenes run, a folder each
  /// Runs a scene on a folder to its end, or goes on with the run it holds. Throws if it is stopped.
  std::function<void(const coupling::Scene& scene, const std::string& folder)> runScene = {};
};

/// One case of a table: it runs and returns its figures. `study` and `seconds` of the rows are filled in by
/// the caller.
struct Study {
  std::string key;    ///< "L3"
  std::string title;  ///< of its rows, unless they have their own
  double cost;        ///< wall time on two cores [s], roughly; decides what --max-cost leaves out
  std::function<std::vector<ResultRow>(const StudyContext&)> run;
};

/// One table: its name is the word on the command line and the stem of its files.
struct Reproduction {
  std::string name;
  std::string title;
  std::vector<Study> studies;
  /// File in the table's folder and caption, shown under the table once a study has made it.
  std::vector<std::pair<std::string, std::string>> plots = {};
};

/// Every table the program can make, in the order of `all`.
const std::vector<Reproduction>& reproductions();

// Each in a file of its own.
Reproduction liquidReproduction();
Reproduction foamReproduction();
Reproduction sceneReproduction();

}  // namespace spume::apps
