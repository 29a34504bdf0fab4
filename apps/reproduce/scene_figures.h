#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/reproduce/foam_metrics.h"
#include "apps/reproduce/scene_run.h"

namespace spume::apps {

/// What the paper prints about a scene; empty where it says nothing.
struct PaperFigures {
  std::string bubbles = {}, contacts = {}, faces = {}, foamSeconds = {}, volumeError = {};
  std::optional<double> aimFoamSeconds = {};  ///< ours, a frame without the liquid at full size [s]
};

/// A full frame holds at least this share of the most bubbles of any frame.
inline constexpr double kFullShare = 0.9;

/// Bubbles younger than this are left out of errors of volume: they were put in where there was no room,
/// and the correction takes a tenth of a second for each factor e [s].
inline constexpr double kSettledAge = 1.0;

/// A row of a run: its resolution says the length that was run.
ResultRow rowOf(const SceneRun& run, const std::string& quantity);
/// The same with the paper's figure beside it.
ResultRow rowOf(const SceneRun& run, const std::string& quantity, const std::string& paper);

/// Most of a column, its mean and its least over the full frames, and the sum and the mean of all. Most, sum
/// and mean of an empty column are 0.
double mostOf(const std::vector<double>& column);
double meanWhenFull(const SceneRun& run, const std::vector<double>& column);
double leastWhenFull(const SceneRun& run, const std::vector<double>& column);
double totalOf(const std::vector<double>& column);
double meanOf(const std::vector<double>& column);

/// Share of a run, at its end, that figures of its later state are averaged over: a pour, while it lasts,
/// tears clusters up.
inline constexpr double kLatePart = 1.0 / 3;
/// Where that part of `size` entries begins, from 0: it holds the share rounded down and one more.
std::size_t lateBegin(std::size_t size);
/// Mean of a column over that part; NaN of nothing.
double lateMean(const std::vector<double>& column);
/// The same of the first third.
double earlyMean(const std::vector<double>& column);

/// Largest |V - V0|/V0 of the grid liquid over the frames, V0 what it should be; 0 without liquid [-].
double worstDrift(const FrameCurves& frames);

/// Bubbles, contacts, faces, seconds and steps a frame, errors of volume, bubbles lost and inside solids.
std::vector<ResultRow> commonFigures(const SceneRun& run, const PaperFigures& paper);

/// Writes `folder`/`name`.svg.
void writePlot(const std::string& folder, const std::string& name, const std::string& svg);

/// Writes the frames of a run as `folder`/`name`.csv, a row a frame.
void writeCurves(const std::string& folder, const std::string& name, const FrameCurves& curves);

}  // namespace spume::apps
