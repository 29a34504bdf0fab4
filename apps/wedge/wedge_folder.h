#pragma once

#include <optional>
#include <string>

#include "apps/wedge/wedge_scripts.h"
#include "apps/wedge/wedge_summary.h"

namespace spume::apps {

/// Writes a sweep: a folder with variant.toml for each variant, wedge.csv, commands.sh and, on request,
/// wedge.sbatch. Nothing is written if anything would be lost: throws coupling::SceneError where a folder
/// holds a run of another scene, and FileError where another program's file is in the way or a file cannot be
/// written. A sweep that is there already may be written again, also longer or with more values.
void writeWedge(const Wedge& wedge, const std::string& folder, const std::string& program,
                const std::optional<SlurmRequest>& slurm);

/// Writes summary.csv of a sweep. Throws coupling::FileError, also where another program's file is in the
/// way.
void writeSummary(const WedgeSummary& summary, const std::string& folder);

}  // namespace spume::apps
