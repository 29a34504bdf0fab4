#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/reproduce/result_table.h"

namespace spume::apps {

/// What a study may use beside its own settings.
struct StudyContext {
  std::string folder;  ///< for caches and pictures; a study that needs it creates it
  int frames = 0;      ///< length of a scene's run; 0: as the scene says
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
};

/// Every table the program can make, in the order of `all`.
const std::vector<Reproduction>& reproductions();

// Each in a file of its own.
Reproduction liquidReproduction();

}  // namespace spume::apps
